// The room on its canvas: walls, doors, discs at true size, contacts and arches.

const LEAST_ZOOM = 1;
const MOST_ZOOM = 40;
const WIDEST = 7; // px, line of the strongest contact
const BAR = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]; // m, lengths of the scale bar

class View {
  constructor(canvas, recording, arches) {
    Object.assign(this, { canvas, recording, arches, zoom: 1, pan: [0, 0], colour: "speed", selected: -1 });
    this.layers = { contacts: true, arches: true };
    this.context = canvas.getContext("2d");
    this.places = new Float64Array(2 * recording.persons);
    this.forces = new Float64Array(recording.persons);
    this.forcesOf = -1; // sample that the forces are of
  }

  // Take the size of the element, at the screen's own resolution.
  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide || this.canvas.height !== high) Object.assign(this.canvas, { width: wide, height: high });
    const [x0, y0, x1, y1] = this.recording.facts.box;
    this.ratio = ratio;
    this.scale = Math.min(width / (x1 - x0), height / (y1 - y0)) * this.zoom; // px per m
    this.origin = [width / 2 - (this.scale * (x0 + x1)) / 2 + this.pan[0], height / 2 + (this.scale * (y0 + y1)) / 2 + this.pan[1]];
  }

  restyle() {
    const names = ["paper", "ink", "wall", "door", "arch", "touch", "casing", "outline", "chosen"];
    this.style = Object.fromEntries(names.map((name) => [name, styled(`--${name}`)]));
  }

  screen(x, y) {
    return [this.origin[0] + this.scale * x, this.origin[1] - this.scale * y];
  }

  world(px, py) {
    return [(px - this.origin[0]) / this.scale, (this.origin[1] - py) / this.scale];
  }

  // Zoom by a factor and keep what is at this place of the canvas there.
  zoomAt(factor, px, py) {
    const zoom = Math.max(LEAST_ZOOM, Math.min(MOST_ZOOM, this.zoom * factor));
    const [x, y] = this.world(px, py);
    this.zoom = zoom;
    this.resize();
    const [qx, qy] = this.screen(x, y);
    this.pan = zoom === LEAST_ZOOM ? [0, 0] : [this.pan[0] + px - qx, this.pan[1] + py - qy];
    this.resize();
  }

  // Look at the first door; at the next one when asked again.
  near() {
    const { doors } = this.arches;
    if (!doors.length) return;
    this.door = ((this.door ?? -1) + 1) % doors.length;
    const { centre, ends } = doors[this.door];
    const wide = Math.max(8 * Math.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]), 4);
    const [x0, y0, x1, y1] = this.recording.facts.box;
    this.pan = [0, 0];
    this.zoom = Math.max(LEAST_ZOOM, Math.min(MOST_ZOOM, Math.min(x1 - x0, y1 - y0) / wide));
    this.resize();
    const [px, py] = this.screen(...centre);
    this.pan = [this.canvas.clientWidth / 2 - px, this.canvas.clientHeight / 2 - py];
    this.resize();
  }

  personAt(px, py) {
    const [x, y] = this.world(px, py);
    const { persons, radius } = this.recording;
    const hit = (i) => Math.hypot(this.places[2 * i] - x, this.places[2 * i + 1] - y) < radius[i];
    for (let i = 0; i < persons; i++) if (hit(i)) return i;
    return -1;
  }

  draw(time, share = true) {
    const { context: c, recording, ratio } = this;
    const k = recording.sampleAt(time);
    recording.placesAt(share ? time : recording.time[k], this.places);
    if (this.forcesOf !== k) recording.forcesAt((this.forcesOf = k), this.forces);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.fillStyle = this.style.paper;
    c.fillRect(0, 0, this.canvas.width, this.canvas.height);
    this.drawDoors(c);
    this.drawTrail(c, time, k);
    this.shown = this.drawPersons(c, k);
    this.drawWalls(c);
    this.lines = this.layers.contacts ? this.drawContacts(c, k) : 0;
    this.found = this.arches.at(k);
    if (this.layers.arches) this.found.forEach((arch) => this.drawArch(c, arch));
    this.drawChosen(c);
    this.drawBar(c);
  }

  drawWalls(c) {
    c.strokeStyle = this.style.wall;
    c.lineWidth = 3;
    c.lineCap = "round";
    c.beginPath();
    for (const [x0, y0, x1, y1] of this.recording.facts.walls) this.line(c, x0, y0, x1, y1);
    c.stroke();
  }

  drawDoors(c) {
    c.strokeStyle = this.style.door;
    c.lineWidth = 3;
    c.setLineDash([6, 5]);
    c.beginPath();
    for (const [x0, y0, x1, y1] of this.recording.facts.doors) this.line(c, x0, y0, x1, y1);
    c.stroke();
    c.setLineDash([]);
  }

  line(c, x0, y0, x1, y1) {
    c.moveTo(...this.screen(x0, y0));
    c.lineTo(...this.screen(x1, y1));
  }

  drawPersons(c, k) {
    const { recording, places, scale } = this;
    c.strokeStyle = this.style.outline;
    c.lineWidth = 1;
    let shown = 0;
    for (let i = 0; i < recording.persons; i++) {
      const x = places[2 * i];
      if (x !== x) continue;
      const [px, py] = this.screen(x, places[2 * i + 1]);
      c.fillStyle = this.colourOf(i, k);
      c.beginPath();
      c.arc(px, py, recording.radius[i] * scale, 0, 2 * Math.PI);
      c.fill();
      c.stroke();
      shown++;
    }
    return shown;
  }

  colourOf(i, k) {
    const { speedTop, forceTop } = this.recording.facts;
    const share = this.colour === "force" ? this.forces[i] / forceTop : this.recording.speedOf(i, k) / speedTop;
    return colourOf(MAPS[this.colour], share);
  }

  // Lines between centres, or to the nearest point of the wall, as wide as the force; one stroke for each width.
  drawContacts(c, k) {
    const { recording } = this;
    const { row, contactForce } = recording;
    const widths = Array.from({ length: WIDEST }, () => []);
    for (let n = row[k]; n < row[k + 1]; n++) {
      const force = contactForce ? contactForce[n] / recording.facts.forceTop : 0.2;
      widths[Math.min(WIDEST - 1, Math.floor(2 * force * WIDEST))].push(n);
    }
    c.lineCap = "round";
    let lines = 0;
    for (const [colour, wider] of [[this.style.casing, 1.5], [this.style.touch, 0]]) {
      c.strokeStyle = colour;
      lines = 0;
      widths.forEach((contacts, w) => {
        c.lineWidth = 0.8 + w + wider;
        c.beginPath();
        for (const n of contacts) lines += this.contact(c, n);
        c.stroke();
      });
    }
    return lines;
  }

  // One line, if both are there: how many were drawn.
  contact(c, n) {
    const { recording, places } = this;
    const [i, j] = [recording.contactI[n], recording.contactJ[n]];
    const [x, y] = [places[2 * i], places[2 * i + 1]];
    const [u, v] = j >= 0 ? [places[2 * j], places[2 * j + 1]] : nearest(recording.facts.walls[-1 - j], x, y);
    if (x !== x || u !== u) return 0;
    this.line(c, x, y, u, v);
    return 1;
  }

  // A path from side to side of a door: a chain, and a ring around each of its persons.
  drawArch(c, arch) {
    const { places } = this;
    const persons = arch.persons.filter((i) => places[2 * i] === places[2 * i]);
    const [from, to] = this.arches.doors[arch.door].ends;
    const chain = [from, ...persons.map((i) => [places[2 * i], places[2 * i + 1]]), to];
    c.lineJoin = "round";
    for (const [colour, width] of [[this.style.paper, 8], [this.style.arch, 4]]) {
      c.strokeStyle = colour;
      c.lineWidth = width;
      c.setLineDash(arch.clean ? [] : [7, 7]);
      c.beginPath();
      chain.forEach(([x, y], at) => (at ? c.lineTo(...this.screen(x, y)) : c.moveTo(...this.screen(x, y))));
      c.stroke();
      c.setLineDash([]);
      for (const i of persons) this.ring(c, i);
    }
  }

  ring(c, i) {
    const [px, py] = this.screen(this.places[2 * i], this.places[2 * i + 1]);
    c.beginPath();
    c.arc(px, py, this.recording.radius[i] * this.scale, 0, 2 * Math.PI);
    c.stroke();
  }

  drawTrail(c, time, k) {
    const { recording, selected, places } = this;
    if (selected < 0) return;
    c.strokeStyle = this.style.chosen;
    c.lineWidth = 2;
    c.beginPath();
    for (let s = 0; s <= k; s++) {
      const at = selected * recording.samples + s;
      if (recording.x[at] === NOTHING) break;
      const point = this.screen(recording.x[at] / 1000, recording.y[at] / 1000);
      if (s) c.lineTo(...point);
      else c.moveTo(...point);
    }
    const x = places[2 * selected];
    if (x === x) c.lineTo(...this.screen(x, places[2 * selected + 1]));
    c.stroke();
  }

  drawChosen(c) {
    if (this.selected < 0 || Number.isNaN(this.places[2 * this.selected])) return;
    c.strokeStyle = this.style.chosen;
    c.lineWidth = 3;
    this.ring(c, this.selected);
  }

  drawBar(c) {
    const length = BAR.filter((metres) => metres * this.scale < 140).pop() ?? BAR[0];
    const [x, y] = [16, this.canvas.clientHeight - 16];
    c.font = "13px system-ui, sans-serif";
    c.textAlign = "left";
    c.textBaseline = "bottom";
    c.lineJoin = "round";
    for (const [colour, width] of [[this.style.paper, 6], [this.style.ink, 2]]) {
      c.strokeStyle = colour;
      c.lineWidth = width;
      c.beginPath();
      c.moveTo(x, y - 5);
      c.lineTo(x, y);
      c.lineTo(x + length * this.scale, y);
      c.lineTo(x + length * this.scale, y - 5);
      c.stroke();
      if (width > 2) c.strokeText(`${length} m`, x + 6, y - 4);
    }
    c.fillStyle = this.style.ink;
    c.fillText(`${length} m`, x + 6, y - 4);
  }
}

// The point of a wall that is nearest to a place.
function nearest([x0, y0, x1, y1], x, y) {
  const [ux, uy] = [x1 - x0, y1 - y0];
  const share = Math.max(0, Math.min(1, ((x - x0) * ux + (y - y0) * uy) / Math.max(ux * ux + uy * uy, 1e-300)));
  return [x0 + share * ux, y0 + share * uy];
}
