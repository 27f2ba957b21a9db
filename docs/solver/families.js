// Which solver an arm gets: the package's rules for the families that this page knows, best first.

const SLACK = 1e-6;  // relative amount by which an equation may miss its rim; the residual decides
const REGULAR = 1e-9;  // determinant of a scaled Jacobian that is none

const turning = (rows, ...joints) => joints.every(i => !rows[i].slides);

const isWrist = rows => rows.length === 6 && turning(rows, 3, 4, 5) && rows[3].sa !== 0 && rows[4].sa !== 0 &&
  rows[3].a === 0 && rows[4].a === 0 && rows[4].d === 0;

const isParallel = rows => rows.length === 6 && turning(rows, 0, 1, 2, 3, 4, 5) &&
  [0, 1].some(i => rows[i].sa === 0 && rows[i + 1].sa === 0);

const CLOSED = [
  [isWrist, "solve_wrist_arm", "spherical wrist", "spherical shoulder"],
  [isParallel, "solve_three_parallel", "three parallel axes", "three parallel axes, from the tool"],
];

// Middle of each range; where a bound is infinite, the allowed value nearest to zero.
const middleOf = ({lower, upper}) => lower.map((low, i) => Number.isFinite(upper[i] - low) ? 0.5 * (low + upper[i]) : Math.min(Math.max(0, low), upper[i]));

// What solves poses of a table: {name, n, size, solve(T, withinLimits)}, or {refused}. Thresholds are
// meant for arms of about a metre: others are solved in a unit of their own, a power of two.
function solverOf(table) {
  top_ = bottom;
  const size = sizeOf(standardRows(table)), unit = size < 1 / 16 || size > 16 ? 2 ** Math.floor(Math.log2(size)) : 1;
  const inner = metreSolverOf(inUnit(table, unit));
  if (unit === 1 || inner.refused) return {...inner, size};
  const {rows} = table, links = linksOf(standardRows(table));
  return {...inner, size, solve(T, within) {
    const answer = inner.solve(shrunk(T, unit), within);
    answer.found.forEach(s => {
      s.q = s.q.map((v, i) => rows[i].slides ? v * unit : v);
      s.residual = poseError(forward(links, rows, s.q), T, inner.pointOnly);
    });
    return answer;
  }};
}

const shrunk = (T, unit) => T.map((v, k) => k % 4 === 3 && k < 12 ? v / unit : v);

function inUnit(table, unit) {
  const bound = (v, i) => table.rows[i].slides ? v / unit : v;
  return {...table, base: shrunk(table.base, unit), tool: shrunk(table.tool, unit), lower: table.lower.map(bound), upper: table.upper.map(bound),
    rows: table.rows.map(row => ({...row, a: row.a / unit, d: row.d / unit}))};
}

// The larger of the distance [m] and the sine of the angle between two poses.
function poseError(found, T, pointOnly) {
  const row = (M, i) => M.slice(4 * i, 4 * i + 3);  // of M Rot^T, which is symmetric where both are one
  const turn = [[1, 2], [2, 0], [0, 1]].map(([i, j]) => 0.5 * (dot(row(found, i), row(T, j)) - dot(row(found, j), row(T, i))));
  return Math.max(distance(origin(found), origin(T)), pointOnly ? 0 : Math.hypot(...turn));
}

function metreSolverOf(table) {
  const chain = standardRows(table), {rows} = chain, n = rows.length, links = linksOf(chain), size = sizeOf(chain);
  const joints = rows.map((row, i) => [row.slides ? 1 : 0, chain.lower[i], chain.upper[i]]);
  const tables = [floats(16 * (n + 1), links), floats(3 * n, joints)];
  const solver = {n, links, rows, size, tables, pose: floats(16), middle: floats(n, middleOf(chain))};
  if (axesParallel(links, n) && n < 6) return planarSolver(solver, chain);
  if (n !== 6) return {...solver, refused: `${n} joints: ${n > 6 ? "one to spare, so that solutions are curves" : "other than parallel ones"}; the package solves it, this page does not`};
  if (!movesEverywhere(solver)) return {...solver, refused: "the arm cannot move its tool in all six directions"};
  for (const back of [false, true]) {
    const seen = back ? reversed(chain) : chain, form = tidied(seen, size);
    for (const [fits, kernel, ...names] of CLOSED) if (fits(form.rows)) return closedSolver(solver, seen, form, kernel, names[+back], back);
  }
  if (!turning(rows, 0, 1, 2, 3, 4, 5)) return {...solver, refused: "a slide without three turning axes that meet at the wrist or at the shoulder"};
  const arm = planned(links, rows), out = outputs(16, 6), doubt = integers(1);
  return Object.assign(solver, {name: "general 6R", solve(T, within) {
    solver.pose.set(T);
    kernels.solve_general_6r(1, arm, solver.pose, out.q, out.residual, out.count, doubt);
    kernels.finish_batch(n + 1, n, n, 1, 16, ...tables, solver.pose, within, ...handed(out));
    bringInside(solver, out, within);
    return {found: solutionsOf(out), doubt: doubt[0] !== 0n};
  }});
}

function closedSolver(solver, chain, form, kernel, name, back) {
  const {n, tables, pose} = solver, out = outputs(8, 6), turned = floats(16);
  const rows = form.rows.flatMap(r => [r.a, r.ca, r.sa, r.d, r.theta, r.slides ? 1 : 0, r.sign]);
  const ends = floats(48, [inverse(form.base), inverse(form.tool), form.tool]);
  const own = back ? [floats(16 * 7, linksOf(chain)), floats(18, chain.rows.map((r, i) => [r.slides ? 1 : 0, chain.lower[i], chain.upper[i]]))] : tables;
  const arm = [...own, floats(42, rows), ends];
  return Object.assign(solver, {name, solve(T, within) {
    pose.set(T);
    if (back) turned.set(inverse(T));
    kernels[kernel](1, ...arm, SLACK, back ? turned : pose, within && !back, ...handed(out));
    const doubt = settle(out);
    if (back) kernels.turn_back(n + 1, n, n, 1, 8, ...tables, pose, within, ...handed(out));
    bringInside(solver, out, within);
    return {found: solutionsOf(out), doubt};
  }});
}

const axesParallel = (links, n) => {
  const axes = placesOf(links).slice(0, n).map(T => column(T, 2));
  return axes.every(z => Math.abs(Math.abs(dot(z, axes[0])) - 1) <= SNAP);
};

// Two or three turning joints with parallel axes, and a slide along them or none.
function planarSolver(solver, chain) {
  const {n, rows, links, tables, pose} = solver, places = placesOf(links);
  const turns = rows.flatMap((row, i) => row.slides ? [] : [i]), slides = rows.flatMap((row, i) => row.slides ? [i] : []);
  if (![2, 3].includes(turns.length) || slides.length > 1) return {...solver, refused: "parallel axes: two or three that turn and one that slides at most"};
  const first = places[turns[0]], z = column(first, 2), tool = places[n], whole = turns.length === 3;
  const across = p => { const v = add(p, origin(first), -1); return add(v, z, -dot(v, z)); };
  const way = across(origin(places[turns[1]])), link1 = Math.hypot(...way);
  const x = link1 > SNAP * solver.size ? way.map(v => v / link1) : column(first, 0);
  const y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]];
  const frame = [0, 1, 2].flatMap(k => [x[k], y[k], z[k], first[4 * k + 3]]).concat([0, 0, 0, 1]);
  const last = whole ? places[turns[2]] : tool, seen = origin(mul(inverse(frame), last));
  const [u, v] = [seen[0] - link1, seen[1]], signs = [...turns, ...slides].map(i => Math.sign(dot(column(places[i], 2), z)));
  const point = origin(mul(inverse(tool), last)), rest = Math.min(Math.max(0, chain.lower[turns[0]]), chain.upper[turns[0]]);
  const numbers = [link1, Math.hypot(u, v), Math.atan2(v, u), signs[1], whole ? signs[2] : 1, ...point, rest, slides.length ? signs[signs.length - 1] : 1, seen[2]];
  const plane = floats(32, [inverse(frame), mul(inverse(tool), frame)]), form = floats(11, numbers), out = outputs(2, n);
  const where = integers(4, [...[...turns, -1].slice(0, 3), slides[0] ?? -1]);
  return Object.assign(solver, {name: whole ? "planar arm" : "planar arm, for the position", pointOnly: !whole, solve(T, within) {
    pose.set(T);
    kernels.solve_planar(n, 1, ...tables, where, plane, form, whole, pose, within, ...handed(out));
    const doubt = settle(out);
    bringInside(solver, out, within);
    return {found: solutionsOf(out), doubt};
  }});
}

// Whether the tool moves in all six directions at one of a few configurations.
function movesEverywhere({links, rows, size}) {
  const next = random(2);
  return [0, 1, 2, 3].some(() => {
    const q = rows.map(row => row.slides ? size * next() : Math.PI * next()), places = [links[0]];
    rows.forEach((row, i) => places.push(product(places[i], row.slides ? shiftZ(q[i]) : turnZ(q[i]), links[i + 1])));
    const tip = origin(places[6]);
    const J = rows.map((row, i) => {
      const z = column(places[i], 2), r = add(tip, origin(places[i]), -1).map(v => v / size);
      return row.slides ? [...z, 0, 0, 0] : [z[1] * r[2] - z[2] * r[1], z[2] * r[0] - z[0] * r[2], z[0] * r[1] - z[1] * r[0], ...z];
    });
    return Math.abs(determinant(J)) > REGULAR;
  });
}

function determinant(A) {
  const rows = A.map(row => [...row]);
  let value = 1;
  for (let i = 0; i < rows.length; i++) {
    const pivot = rows.slice(i).reduce((best, row, k) => Math.abs(row[i]) > Math.abs(rows[best][i]) ? k + i : best, i);
    if (pivot !== i) { [rows[i], rows[pivot]] = [rows[pivot], rows[i]]; value = -value; }
    if (rows[i][i] === 0) return 0;
    value *= rows[i][i];
    for (const row of rows.slice(i + 1)) { const f = row[i] / rows[i][i]; row.forEach((v, k) => { row[k] = v - f * rows[i][k]; }); }
  }
  return value;
}
