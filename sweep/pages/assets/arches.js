// Blocking clusters (Parisi & Dorso 2005, Sec. 4.3): among the paths of persons inside, in touch from one side of a door
// to the other, the one with the least sum of squared distances to the door's centre. It is clean, and the door shut, if
// nobody else's centre lies in the polygon of the path and the door's ends.

const SAME_POINT = 1e-6; // m, between an end of a door and the end of a wall beside it

class Arches {
  constructor(recording) {
    this.recording = recording;
    this.known = new Map();
    this.doors = recording.facts.doors.map((line) => this.doorOf(line));
  }

  doorOf(line) {
    const ends = [line.slice(0, 2), line.slice(2)];
    const centre = [(line[0] + line[2]) / 2, (line[1] + line[3]) / 2];
    const beside = ends.map((end) => {
      const near = (wall, at) => Math.hypot(wall[at] - end[0], wall[at + 1] - end[1]) < SAME_POINT;
      return new Set(this.recording.facts.walls.flatMap((wall, w) => (near(wall, 0) || near(wall, 2) ? [w] : [])));
    });
    return { ends, centre, beside };
  }

  // [{door, persons, clean}] of a sample.
  at(k) {
    if (!this.known.has(k)) this.known.set(k, this.found(k));
    return this.known.get(k);
  }

  found(k) {
    const { recording } = this;
    const { row, contactI, contactJ, time } = recording;
    const inside = (person) => recording.leavingTime(person) > time[k] + 1e-9 && recording.x[person * recording.samples + k] !== NOTHING;
    const near = new Map();
    const walls = new Map();
    for (let c = row[k]; c < row[k + 1]; c++) {
      const [i, j] = [contactI[c], contactJ[c]];
      if (!inside(i) || (j >= 0 && !inside(j))) continue;
      if (j < 0) added(walls, i, -1 - j);
      else {
        added(near, i, j);
        added(near, j, i);
      }
    }
    return this.doors.flatMap((door, number) => {
      const [first, second] = door.beside.map((sides) => [...walls].filter(([, ws]) => ws.some((w) => sides.has(w))).map(([i]) => i));
      const persons = this.lightestPath(k, door, near, first, new Set(second));
      return persons ? [{ door: number, persons, clean: this.clean(k, door, persons, inside) }] : [];
    });
  }

  place(k, person) {
    const at = person * this.recording.samples + k;
    return [this.recording.x[at] / 1000, this.recording.y[at] / 1000];
  }

  weight(k, door, person) {
    const [x, y] = this.place(k, person);
    return (x - door.centre[0]) ** 2 + (y - door.centre[1]) ** 2;
  }

  // Dijkstra's algorithm with weights of persons.
  lightestPath(k, door, near, first, second) {
    const open = new Map(first.map((person) => [person, this.weight(k, door, person)]));
    const before = new Map(first.map((person) => [person, -1]));
    const closed = new Set();
    while (open.size) {
      const [person, weight] = [...open].reduce((a, b) => (b[1] < a[1] ? b : a));
      open.delete(person);
      closed.add(person);
      if (second.has(person)) return back(before, person);
      for (const other of near.get(person) ?? []) {
        const longer = weight + this.weight(k, door, other);
        if (closed.has(other) || longer >= (open.get(other) ?? Infinity)) continue;
        open.set(other, longer);
        before.set(other, person);
      }
    }
    return null;
  }

  clean(k, door, persons, inside) {
    const corners = [door.ends[0], ...persons.map((person) => this.place(k, person)), door.ends[1]];
    const members = new Set(persons);
    for (let person = 0; person < this.recording.persons; person++)
      if (!members.has(person) && inside(person) && within(corners, this.place(k, person))) return false;
    return true;
  }
}

function added(lists, key, value) {
  if (lists.has(key)) lists.get(key).push(value);
  else lists.set(key, [value]);
}

function back(before, last) {
  const path = [];
  for (let person = last; person !== -1; person = before.get(person)) path.unshift(person);
  return path;
}

// Whether a point lies in a polygon: a ray from it crosses the outline an odd number of times.
function within(corners, [x, y]) {
  let odd = false;
  for (let a = 0, b = corners.length - 1; a < corners.length; b = a++) {
    const [[xa, ya], [xb, yb]] = [corners[a], corners[b]];
    if (ya > y !== yb > y && x < ((xb - xa) * (y - ya)) / (yb - ya) + xa) odd = !odd;
  }
  return odd;
}
