// Buttons, keys and the clock.

const RATES = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 32];
const CHUNK = 12; // ms of looking for shut doors at a time
const element = (id) => document.getElementById(id);

class Player {
  constructor(recording) {
    this.recording = recording;
    this.arches = new Arches(recording);
    this.view = new View(element("room"), recording, this.arches);
    this.curve = new Curve(element("curve"), recording);
    this.still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    Object.assign(this, { time: recording.begin, playing: false, rate: 1, frames: 0, drawing: 0, waiting: false });
    element("time").max = recording.samples - 1;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    this.connect();
    this.paint(dark ? "dark" : "light");
    new ResizeObserver(() => this.fit()).observe(element("room").parentElement);
    // Another screen's resolution may change no size, and then no browser-independent event tells of it.
    setInterval(() => window.devicePixelRatio !== this.view.ratio && this.fit(), 500);
    this.seekShut(0);
    if (!this.still) this.play(true);
  }

  state() {
    const { view, recording, time, playing, rate } = this;
    return {
      time, playing, rate, sample: recording.sampleAt(time), samples: recording.samples, inside: recording.inside(time),
      shown: view.shown, lines: view.lines, arches: view.found, colour: view.colour, zoom: view.zoom,
      selected: view.selected, theme: document.documentElement.dataset.theme, frames: this.frames,
      drawMs: this.frames ? this.drawing / this.frames : 0, shutKnown: this.shutKnown, layers: { ...view.layers },
    };
  }

  // Where a person is on the page, px, and its radius.
  screenOf(person) {
    const box = this.view.canvas.getBoundingClientRect();
    const [x, y] = this.view.screen(this.view.places[2 * person], this.view.places[2 * person + 1]);
    return [box.left + x, box.top + y, this.recording.radius[person] * this.view.scale];
  }

  // The colour that a person has now: red, green, blue of 0 to 255.
  colourOf(person) {
    return this.view.colourOf(person, this.recording.sampleAt(this.time)).match(/\d+/g).map(Number);
  }

  play(on) {
    if (on && this.time >= this.recording.end) this.time = this.recording.begin;
    this.playing = on;
    this.last = undefined;
    element("sign").setAttribute("d", on ? "M3 2h4v12H3zM9 2h4v12H9z" : "M4 2l10 6-10 6z");
    element("play").setAttribute("aria-label", on ? "Pause" : "Play");
    this.request();
  }

  seek(time) {
    this.time = Math.max(this.recording.begin, Math.min(this.recording.end, time));
    this.request();
  }

  // So many samples on, or back, standing.
  step(samples) {
    this.play(false);
    const { recording } = this;
    const k = recording.sampleAt(this.time);
    const between = recording.time[k] < this.time - 1e-9 && samples < 0; // back to the sample just passed
    this.seek(recording.time[Math.max(0, Math.min(recording.samples - 1, k + samples + (between ? 1 : 0)))]);
  }

  faster(steps) {
    this.setRate(RATES[Math.max(0, Math.min(RATES.length - 1, RATES.indexOf(this.rate) + steps))]);
  }

  setRate(rate) {
    this.rate = rate;
    element("rate").value = rate;
  }

  setColour(colour) {
    if (colour === "force" && !this.recording.contactForce) return;
    this.view.colour = colour;
    element(`by-${colour}`).checked = true;
    this.legend();
    this.request();
  }

  toggle(layer) {
    const on = (this.view.layers[layer] = !this.view.layers[layer]);
    element(`show-${layer}`).checked = on;
    this.request();
  }

  choose(person) {
    this.view.selected = person;
    this.request();
  }

  paint(theme) {
    document.documentElement.dataset.theme = theme;
    element("theme").setAttribute("aria-pressed", theme === "dark");
    this.view.restyle();
    this.legend();
    this.fit();
  }

  fit() {
    this.view.resize();
    this.curve.renew();
    this.request();
  }

  whole() {
    Object.assign(this.view, { zoom: 1, pan: [0, 0] });
    this.fit();
  }

  near() {
    this.view.near();
    this.request();
  }

  request() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      this.frame(now);
    });
  }

  frame(now) {
    const { recording } = this;
    if (this.playing) {
      const passed = this.last === undefined ? 0 : Math.min((now - this.last) / 1000, 0.25);
      this.last = now;
      this.time = Math.min(recording.end, this.time + passed * this.rate);
      if (this.time >= recording.end) this.play(false);
    }
    const begun = performance.now();
    this.view.draw(this.time, !this.still);
    this.curve.draw(this.time);
    this.say();
    this.drawing += performance.now() - begun;
    this.frames++;
    if (this.playing) this.request();
  }

  say() {
    const { recording, time, view } = this;
    const inside = recording.inside(time);
    const k = recording.sampleAt(time);
    const arch = view.found.find((one) => one.clean) ?? view.found[0];
    put("now", `${time.toFixed(1)} s`);
    put("inside", inside);
    put("out", recording.persons - inside);
    put("touching", recording.row[k + 1] - recording.row[k]);
    put("arch", arch ? `${arch.persons.length} persons${arch.clean ? "" : ", around somebody"}` : "none");
    put("chosen", this.words(k));
    if (document.activeElement !== element("time") || element("time").value != k) element("time").value = k;
    element("time").setAttribute("aria-valuetext", `${time.toFixed(1)} s, ${inside} inside`);
  }

  words(k) {
    const { view, recording } = this;
    const person = view.selected;
    if (person < 0) return "";
    const speed = recording.speedOf(person, k);
    const left = recording.leavingTime(person);
    if (Number.isNaN(speed)) return `person ${person} left at ${left.toFixed(1)} s`;
    const force = recording.contactForce ? `, ${view.forces[person]} N` : "";
    return `person ${person}: ${speed.toFixed(2)} m/s${force}`;
  }

  legend() {
    const { colour } = this.view;
    const { speedTop, forceTop } = this.recording.facts;
    const top = colour === "force" ? forceTop : speedTop;
    const map = MAPS[colour];
    element("ramp").style.background = `linear-gradient(to right, ${map.filter((_, k) => k % 7 === 0).join(",")})`;
    put("quantity", colour === "force" ? "contact force on a person, N" : "speed, m/s");
    put("low", 0);
    put("middle", Number((top / 2).toPrecision(3)));
    put("high", `${Number(top.toPrecision(3))} or more`);
  }

  // Find the samples at which a door is shut, a little at a time.
  seekShut(k) {
    const until = performance.now() + CHUNK;
    const { samples } = this.recording;
    for (; k < samples && performance.now() < until; k++) this.curve.shut[k] = this.arches.at(k).some((arch) => arch.clean);
    this.shutKnown = k;
    if (k < samples) setTimeout(() => this.seekShut(k), CHUNK);
    else this.curve.renew();
    this.request();
  }

  connect() {
    const on = (id, event, act) => element(id).addEventListener(event, act);
    on("play", "click", () => this.play(!this.playing));
    on("back", "click", () => this.step(-1));
    on("on", "click", () => this.step(1));
    on("first", "click", () => this.seek(this.recording.begin));
    on("last", "click", () => this.seek(this.recording.end));
    on("time", "input", () => this.seek(this.recording.time[element("time").value]));
    on("rate", "change", () => this.setRate(Number(element("rate").value)));
    on("theme", "click", () => this.paint(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
    on("near", "click", () => this.near());
    on("whole", "click", () => this.whole());
    for (const colour of ["speed", "force"]) on(`by-${colour}`, "change", () => this.setColour(colour));
    for (const layer of ["contacts", "arches"]) on(`show-${layer}`, "change", () => this.toggle(layer));
    element("by-force").disabled = !this.recording.contactForce;
    for (const rate of RATES) element("rate").add(new Option(`${rate} ×`, rate, rate === 1, rate === 1));
    addEventListener("keydown", (event) => this.key(event));
    this.connectCurve();
    this.connectRoom();
  }

  connectCurve() {
    const canvas = element("curve");
    const seek = (event) => this.seek(this.curve.timeAt(event.clientX - canvas.getBoundingClientRect().left));
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons && seek(event));
  }

  // Drag to move, wheel to zoom, click to choose a person.
  connectRoom() {
    const { canvas } = this.view;
    const at = (event) => [event.clientX - canvas.getBoundingClientRect().left, event.clientY - canvas.getBoundingClientRect().top];
    let from = null;
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.view.zoomAt(Math.exp(-event.deltaY / 400), ...at(event));
      this.request();
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      from = { start: at(event), pan: [...this.view.pan] };
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from || this.view.zoom === 1) return;
      const [px, py] = at(event);
      this.view.pan = [from.pan[0] + px - from.start[0], from.pan[1] + py - from.start[1]];
      this.view.resize();
      this.request();
    });
    canvas.addEventListener("pointerup", (event) => {
      const [px, py] = at(event);
      if (from && Math.hypot(px - from.start[0], py - from.start[1]) < 4) this.choose(this.view.personAt(px, py));
      from = null;
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { tagName, type } = event.target;
    if (tagName === "SELECT" || (type === "radio" && event.key.startsWith("Arrow"))) return;
    if (event.key === " " && ["BUTTON", "SUMMARY"].includes(tagName)) return; // their own
    if (event.key === " " && ["radio", "checkbox"].includes(type)) return;
    const act = this.acts()[event.key];
    if (!act) return;
    event.preventDefault();
    act(event.shiftKey);
  }

  acts() {
    const far = Math.max(1, Math.round(this.recording.samples / 50));
    return {
      " ": () => this.play(!this.playing),
      ArrowLeft: (shift) => this.step(shift ? -far : -1),
      ArrowRight: (shift) => this.step(shift ? far : 1),
      Home: () => this.seek(this.recording.begin),
      End: () => this.seek(this.recording.end),
      "+": () => this.faster(1),
      "=": () => this.faster(1),
      "-": () => this.faster(-1),
      f: () => this.setColour(this.view.colour === "speed" ? "force" : "speed"),
      c: () => this.toggle("contacts"),
      a: () => this.toggle("arches"),
      b: () => element("theme").click(),
      d: () => this.near(),
      0: () => this.whole(),
      Escape: () => this.choose(-1),
    };
  }
}

function put(id, text) {
  if (element(id).textContent !== String(text)) element(id).textContent = text;
}

recordingOf(JSON.parse(element("facts").textContent))
  .then((recording) => (window.player = new Player(recording)))
  .catch((error) => {
    put("outcome", `This browser cannot play the run (${error.message}): use one of 2023 or later.`);
    throw error;
  });
