// Persons inside against time, with a mark at the present, and below it when a door is shut.

const AXIS = { left: 40, right: 12, top: 10, bottom: 40, strip: 8 }; // px

class Curve {
  constructor(canvas, recording) {
    Object.assign(this, { canvas, recording, shut: new Uint8Array(recording.samples) });
    this.context = canvas.getContext("2d");
    this.still = document.createElement("canvas"); // all but the mark
  }

  // Draw anew what does not move.
  renew() {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    Object.assign(this, { ratio, width, height });
    for (const canvas of [this.canvas, this.still]) Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const c = this.still.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.drawAxes(c);
    this.drawSteps(c);
    this.drawStrip(c);
  }

  px(time) {
    const { begin, end } = this.recording;
    return AXIS.left + ((time - begin) / Math.max(end - begin, 1e-9)) * (this.width - AXIS.left - AXIS.right);
  }

  py(persons) {
    const bottom = this.height - AXIS.bottom;
    return bottom - (persons / this.recording.persons) * (bottom - AXIS.top);
  }

  timeAt(px) {
    const { begin, end } = this.recording;
    const share = (px - AXIS.left) / (this.width - AXIS.left - AXIS.right);
    return begin + Math.max(0, Math.min(1, share)) * (end - begin);
  }

  drawAxes(c) {
    const { recording } = this;
    c.strokeStyle = styled("--line");
    c.fillStyle = styled("--soft");
    c.font = "12px system-ui, sans-serif";
    c.lineWidth = 1;
    c.beginPath();
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (const n of ticks(0, recording.persons, 4)) {
      c.moveTo(AXIS.left, this.py(n));
      c.lineTo(this.width - AXIS.right, this.py(n));
      c.fillText(n, AXIS.left - 6, this.py(n));
    }
    c.textAlign = "center";
    c.textBaseline = "top";
    const bottom = this.height - AXIS.bottom;
    for (const t of ticks(recording.begin, recording.end, 5)) {
      c.moveTo(this.px(t), bottom);
      c.lineTo(this.px(t), bottom + AXIS.strip + 4);
      c.fillText(t, this.px(t), bottom + AXIS.strip + 6);
    }
    c.stroke();
    c.textAlign = "right";
    c.textBaseline = "bottom";
    c.fillText("time, s", this.width - AXIS.right, this.height);
  }

  drawSteps(c) {
    const { recording } = this;
    c.strokeStyle = styled("--curve");
    c.lineWidth = 2;
    c.lineJoin = "round";
    c.beginPath();
    let inside = recording.persons;
    c.moveTo(this.px(recording.begin), this.py(inside));
    for (const time of recording.facts.exits.time) {
      if (time > recording.end) break;
      c.lineTo(this.px(time), this.py(inside));
      c.lineTo(this.px(time), this.py(--inside));
    }
    c.lineTo(this.px(recording.end), this.py(inside));
    c.stroke();
  }

  drawStrip(c) {
    const { recording } = this;
    const top = this.height - AXIS.bottom + 2;
    c.fillStyle = styled("--arch");
    for (let k = 0; k < recording.samples; k++) {
      if (!this.shut[k]) continue;
      const from = this.px(recording.time[k]);
      const to = this.px(recording.time[Math.min(k + 1, recording.samples - 1)]);
      c.fillRect(from, top, Math.max(to - from, 1), AXIS.strip - 2);
    }
  }

  draw(time) {
    const { context: c, ratio } = this;
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    c.drawImage(this.still, 0, 0);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    const [x, y] = [this.px(time), this.py(this.recording.inside(time))];
    c.strokeStyle = c.fillStyle = styled("--ink");
    c.lineWidth = 1;
    c.beginPath();
    c.moveTo(x, AXIS.top);
    c.lineTo(x, this.height - AXIS.bottom + AXIS.strip);
    c.stroke();
    c.beginPath();
    c.arc(x, y, 5, 0, 2 * Math.PI);
    c.fill();
  }
}

// Round numbers from low to high, about so many.
function ticks(low, high, about) {
  const raw = Math.max(high - low, 1e-9) / about;
  const ten = 10 ** Math.floor(Math.log10(raw));
  const step = ten * ([1, 2, 5, 10].find((part) => part * ten >= raw) ?? 10);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9; k++) found.push(Number((k * step).toPrecision(6)));
  return found;
}
