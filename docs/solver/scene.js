// The arm and its solutions as lines with round ends, the far ones first.

const canvas = document.getElementById("scene"), pen = canvas.getContext("2d");
const COLOURS = ["#1f6fb4", "#d9782d", "#3f9b46", "#b5384a", "#7d5fb2", "#8a6a3b", "#c868ae", "#4f9fa8",
  "#a0a43a", "#5673c9", "#e09a7a", "#6fae87", "#93465f", "#9f86c7", "#b39b73", "#6b7480"];

const colourOf = k => COLOURS[k % COLOURS.length];

// Points along the arm: after each motion of each row, and the tool.
function pathOf(q) {
  const points = [[0, 0, 0]];
  let T = arm.first;
  points.push(origin(T));
  arm.rows.forEach((row, i) => motionsOf(row, q[i]).forEach(M => { T = mul(T, M); points.push(origin(T)); }));
  return [...points, origin(mul(T, arm.tool))].filter((p, k, all) => !k || distance(p, all[k - 1]) > 1e-6 * arm.size);
}

// Pieces of the joints' axes, which turn or slide, and where they stand.
function drumsOf(q, wide) {
  let T = arm.first;
  return arm.rows.map((row, i) => {
    const along = arm.standard ? T : motionsOf(row, q[i]).slice(0, 2).reduce(mul, T);
    const centre = origin(along), z = column(along, 2).map(v => v * 0.045 * wide * arm.size);
    T = motionsOf(row, q[i]).reduce(mul, T);
    return {ends: [add(centre, z, -1), add(centre, z)], slides: row.slides};
  });
}

// Rods and drums of a configuration, in their own colour and widths in pixels.
function partsOf(q, colour, wide, opacity) {
  const unit = eye.scale * arm.size * wide, path = pathOf(q);
  const rods = path.slice(1).map((p, k) => ({ends: [path[k], p], width: 0.026 * unit, colour, opacity}));
  const drums = drumsOf(q, wide).map(({ends, slides}) => ({ends, width: (slides ? 0.062 : 0.056) * unit, colour, opacity, drum: !slides, slide: slides}));
  return [...rods, ...drums];
}

// A part in the picture: a rod, a box seen as a thick line, or a drum with the end that is seen.
function paint({at: [a, b], width, colour, drum, slide}, edge) {
  line(a, b, width + 2 * edge, edge ? "#fff" : colour, drum ? "butt" : slide ? "square" : "round");
  if (!drum) return;
  const [dx, dy, along] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]], flat = Math.hypot(dx, dy);
  const tilt = Math.abs(along) / Math.max(Math.hypot(flat / eye.scale, along), 1e-12), angle = Math.atan2(dy, dx);
  for (const [end, lit] of along > 0 ? [[a, 0], [b, 1]] : [[b, 0], [a, 1]]) {
    pen.beginPath();
    pen.ellipse(end[0], end[1], tilt * width / 2 + edge, width / 2 + edge, angle, 0, 2 * Math.PI);
    pen.fillStyle = edge ? "#fff" : colour;
    pen.fill();
    if (lit && !edge) { pen.fillStyle = "rgb(255 255 255 / 30%)"; pen.fill(); }
  }
}

function line(a, b, width, colour, cap = "round") {
  Object.assign(pen, {lineWidth: width, strokeStyle: colour, lineCap: cap});
  pen.beginPath();
  pen.moveTo(a[0], a[1]);
  pen.lineTo(b[0], b[1]);
  pen.stroke();
}

function drawFloor() {
  const cell = 10 ** Math.floor(Math.log10(arm.size / 2)), half = 10;
  for (let k = -half; k <= half; k++) {
    line(project([k * cell, -half * cell, 0]), project([k * cell, half * cell, 0]), 1, "#e8ebef");
    line(project([-half * cell, k * cell, 0]), project([half * cell, k * cell, 0]), 1, "#e8ebef");
  }
}

function drawFrame(T, size) {
  ["#d03a30", "#3f9b46", "#2b62c9"].forEach((colour, k) => line(project(origin(T)), project(add(origin(T), column(T, k), size)), 2.5, colour));
}

// Put the arm and all solutions into the picture.
function lookAtSolutions(solutions, q) {
  const points = [q, ...solutions.map(s => s.q)].flatMap(pathOf), [right, up] = view();
  const spans = [right, up].map(axis => points.map(p => dot(p, axis))).map(along => [Math.min(...along), Math.max(...along)]);
  const low = [0, 1, 2].map(k => Math.min(...points.map(p => p[k]))), high = [0, 1, 2].map(k => Math.max(...points.map(p => p[k])));
  eye.target = low.map((v, k) => (v + high[k]) / 2);
  [right, up].forEach((axis, k) => { eye.target = add(eye.target, axis, (spans[k][0] + spans[k][1]) / 2 - dot(eye.target, axis)); });
  const room = 0.25 * arm.size;
  eye.scale = Math.min(main.clientWidth / (spans[0][1] - spans[0][0] + room), main.clientHeight / (spans[1][1] - spans[1][0] + room));
}

// Draw solutions, the chosen one solid, and the pose that they reach.
function drawScene(solutions, chosen, q, T) {
  const ratio = window.devicePixelRatio || 1, size = [main.clientWidth * ratio, main.clientHeight * ratio].map(Math.round);
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.globalAlpha = 1;
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, main.clientWidth, main.clientHeight);
  drawFloor();
  const parts = solutions.flatMap((s, k) => k === chosen ? [] : partsOf(s.q, colourOf(k), 0.62, 0.42));
  parts.push(...partsOf(q, chosen < 0 ? "#8a93a3" : colourOf(chosen), 1, 1));
  const placed = parts.map(part => ({...part, at: part.ends.map(project)}));
  placed.sort((a, b) => a.opacity - b.opacity || a.at[0][2] + a.at[1][2] - b.at[0][2] - b.at[1][2]);
  for (const part of placed) {
    pen.globalAlpha = part.opacity;
    if (part.opacity === 1) paint(part, 1.5);
    paint(part, 0);
  }
  pen.globalAlpha = 1;
  drawFrame(I4, 0.12 * arm.size);
  drawFrame(T, 0.16 * arm.size);
}
