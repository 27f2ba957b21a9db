// Frames, lengths, angles and their names, drawn over the bodies.

const marks = document.getElementById("marks");
const pen = marks.getContext("2d");
const LENGTH = 0.13 * arm.size;

function stroke(points, colour, width, dash = []) {
  pen.beginPath();
  points.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y));
  Object.assign(pen, {strokeStyle: colour, lineWidth: width, lineCap: "butt", lineJoin: "round"});
  pen.setLineDash(dash);
  pen.stroke();
}

const line = (points, ...style) => stroke(points.map(project), ...style);

// A word centred at a place of the picture, on a pale halo.
function word(shown, [x, y], colour, size = 14) {
  Object.assign(pen, {font: `600 ${size}px system-ui, "DejaVu Sans", sans-serif`, textAlign: "center", textBaseline: "middle"});
  pen.setLineDash([]);
  Object.assign(pen, {strokeStyle: "rgba(255,255,255,0.9)", lineWidth: 4, lineJoin: "round", fillStyle: colour});
  pen.strokeText(shown, x, y);
  pen.fillText(shown, x, y);
}

function arrow(from, to, colour, width) {
  const [a, b] = [project(from), project(to)], long = Math.hypot(b[0] - a[0], b[1] - a[1]), head = Math.min(3.2 * width + 3, long);
  if (long < 1) return;
  const [ux, uy] = [(b[0] - a[0]) / long, (b[1] - a[1]) / long], neck = [b[0] - head * ux, b[1] - head * uy];
  stroke([a, b], "rgba(255,255,255,0.8)", width + 2.5);
  stroke([a, neck], colour, width);
  const half = 0.42 * head;
  pen.beginPath();
  pen.moveTo(b[0], b[1]);
  pen.lineTo(neck[0] - half * uy, neck[1] + half * ux);
  pen.lineTo(neck[0] + half * uy, neck[1] - half * ux);
  pen.fillStyle = colour;
  pen.fill();
}

// The axes of a frame, the farthest first; returns where the names of x and z go.
function axes(T, length, width) {
  const o = origin(T), away = k => project(column(T, k))[2];
  [0, 1, 2].sort((a, b) => away(a) - away(b)).forEach(k => {
    const thin = k === 1 ? 0.6 : 1;
    arrow(o, add(o, column(T, k), thin * length), arm.colours["xyz"[k]], thin * width);
  });
  return ["x", "z"].map((letter, k) => [letter, project(add(o, column(T, 2 * k), 1.17 * length))]);
}

// Names of axes; those that would lie on one another are written side by side.
function names(list) {
  const groups = [];
  for (const [name, place] of list) {
    const near = groups.find(g => Math.hypot(g.place[0] - place[0], g.place[1] - place[1]) < 15);
    near ? near.names.push(name) : groups.push({names: [name], place});
  }
  groups.forEach(g => word(g.names.join(", "), g.place, arm.colours[g.names[0][0]], 13));
}

// DH frames from number ``first`` on; those that stand far away are drawn on the arm.
function drawFrames(placed, first) {
  const list = [];
  placed.forEach((T, k) => {
    const moved = [...T], i = first + k;
    add(origin(T), column(T, 2), arm.shifts[i]).forEach((v, j) => moved[4 * j + 3] = v);
    const mark = arm.shifts[i] ? "′" : "";
    axes(moved, 0.85 * LENGTH, 3).forEach(([letter, place]) => list.push([letter + mark + subscripts(i), place]));
  });
  names(list);
}

// An arc about axis ``k`` of a frame, from its axis ``from``, through an angle, with its value.
function arc(T, k, from, angle, colour, width, label) {
  const o = origin(T), start = column(T, from), axis = column(T, k), radius = (k ? 0.85 : 1.05) * LENGTH;
  const side = [1, 2, 3].map((_, i) => axis[(i + 1) % 3] * start[(i + 2) % 3] - axis[(i + 2) % 3] * start[(i + 1) % 3]);
  const turn = angle % (2 * Math.PI), point = t => add(add(o, start, radius * Math.cos(t)), side, radius * Math.sin(t));
  const count = Math.max(2, Math.ceil(Math.abs(turn) / 0.06)), points = Array.from({length: count + 1}, (_, j) => point(turn * j / count));
  line([o, add(o, start, 1.15 * radius)], colour, 1.2);
  line(points, "rgba(255,255,255,0.8)", width + 2.5);
  line(points, colour, width);
  const out = Math.abs(turn) < 0.6 ? 2.1 : 1.3;  // narrow arcs: beyond the names of the axes
  word(label, project(add(o, add(point(turn / 2), o, -1), out)), colour);
}

// One motion of a row that has been made, from a frame to the next.
function drawMotion([key, , factor], value, before, after, width) {
  const colour = arm.colours[key] ?? "#5b6472", [from, to] = [origin(before), origin(after)];
  if (key === "step") return line([from, to], colour, 2, [6, 4]);
  const label = `${factor.match(/\((.*)\)/)[1]} = ${text(value, KINDS[key])}`;
  if (Math.abs(value) < TINY) return;
  if (KINDS[key] === "angle") return key === "theta" ? arc(before, 2, 0, value, colour, width, label) : arc(before, 0, 2, value, colour, width, label);
  line([from, to], "rgba(255,255,255,0.8)", width + 4);
  line([from, to], colour, width + 1.5);
  const middle = project(add(from, add(to, from, -1), 0.5));
  word(label, [middle[0], middle[1] - 14], colour);
}

// Row i with ``step`` of its motions made: frame i - 1, the frame that moves, what was measured.
function drawRow(i, step, poses, values) {
  const row = arm.rows[i - 1], reach = 1.9 * LENGTH, [first, moving] = [poses[0], poses[step]];
  for (const T of [first, moving])
    line([add(origin(T), column(T, 2), -reach), add(origin(T), column(T, 2), reach)], "#8a93a3", 1.2, [9, 4, 2, 4]);
  const list = axes(first, 1.25 * LENGTH, 4).map(([letter, place]) => [letter + subscripts(i - 1), place]);
  const last = step === row.motions.length;
  if (step) axes(moving, 1.25 * LENGTH, 4).forEach(([letter, place]) => list.push([last ? letter + subscripts(i) : `${letter}′`, place]));
  for (let k = 0; k < step; k++) drawMotion(row.motions[k], values[k], poses[k], poses[k + 1], k === step - 1 ? 5 : 3);
  names(list);
}
