// One recorded run: where everybody is at a time, who touches whom at a sample.

async function recordingOf(facts) {
  const names = ["x", "y", "speed", "rowSize", "contactI", "contactJ"];
  const arrays = await Promise.all(names.map((name) => unpacked(facts[name])));
  const recording = new Recording(facts, Object.fromEntries(names.map((name, k) => [name, arrays[k]])));
  recording.contactForce = facts.contactForce ? await unpacked(facts.contactForce) : null;
  return recording;
}

class Recording {
  constructor(facts, arrays) {
    Object.assign(this, arrays);
    this.facts = facts;
    this.time = Float64Array.from(facts.time);
    this.samples = this.time.length;
    this.radius = Float64Array.from(facts.radius);
    this.persons = this.radius.length;
    this.begin = this.time[0];
    this.end = Math.max(this.time[this.samples - 1], facts.end);
    this.row = new Int32Array(this.samples + 1); // first contact of each sample
    for (let k = 0; k < this.samples; k++) this.row[k + 1] = this.row[k] + this.rowSize[k];
    this.exitOf = new Int32Array(this.persons).fill(-1);
    facts.exits.person.forEach((person, rank) => (this.exitOf[person] = rank));
  }

  // The last sample that is not after this time.
  sampleAt(time) {
    let low = 0;
    let high = this.samples - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  leavingTime(person) {
    const rank = this.exitOf[person];
    return rank < 0 ? Infinity : this.facts.exits.time[rank];
  }

  // Persons who have not crossed an exit by this time.
  inside(time) {
    const exits = this.facts.exits.time;
    let low = 0;
    let high = exits.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (exits[middle] <= time) low = middle + 1;
      else high = middle;
    }
    return this.persons - low;
  }

  // Places at a time, m, into `places` (x, y of each person), NaN for those who are gone.
  placesAt(time, places) {
    const k = this.sampleAt(time);
    const step = k + 1 < this.samples ? this.time[k + 1] - this.time[k] : 1;
    const share = Math.max(0, Math.min(1, (time - this.time[k]) / step));
    for (let person = 0; person < this.persons; person++) this.placeAt(person, k, share, time, places);
  }

  placeAt(person, k, share, time, places) {
    const at = person * this.samples + k;
    const next = k + 1 < this.samples ? this.x[at + 1] : NOTHING;
    let [x, y] = [this.x[at] / 1000, this.y[at] / 1000];
    if (this.x[at] === NOTHING) x = y = NaN;
    else if (share > 0 && next !== NOTHING) {
      x += share * (next / 1000 - x);
      y += share * (this.y[at + 1] / 1000 - y);
    } else if (share > 0) [x, y] = this.leaving(person, k, time, x, y);
    places[2 * person] = x;
    places[2 * person + 1] = y;
  }

  // Straight to the place of leaving, and gone then; those who never leave stay where they were seen last.
  leaving(person, k, time, x, y) {
    const rank = this.exitOf[person];
    const { time: times, x: xs, y: ys } = this.facts.exits;
    if (rank < 0) return [x, y];
    if (times[rank] <= time) return [NaN, NaN];
    const share = (time - this.time[k]) / (times[rank] - this.time[k]);
    return [x + share * (xs[rank] - x), y + share * (ys[rank] - y)];
  }

  // m/s, NaN for those who are gone.
  speedOf(person, k) {
    const speed = this.speed[person * this.samples + k];
    return speed === NOTHING ? NaN : speed / 1000;
  }

  // Sum of the normal contact forces on each person, N.
  forcesAt(k, forces) {
    forces.fill(0);
    if (!this.contactForce) return;
    for (let c = this.row[k]; c < this.row[k + 1]; c++) {
      forces[this.contactI[c]] += this.contactForce[c];
      if (this.contactJ[c] >= 0) forces[this.contactJ[c]] += this.contactForce[c];
    }
  }
}
