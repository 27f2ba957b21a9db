// From a typed table to what the kernels take: the chain, and its rows with exact zeros.
//
// A row is {theta, d, a, alpha, slides, sign}; the table stands at q = 0. Modified rows become
// standard ones between another base and tool: Rx(alpha) Tx(a) of the first row goes to the base.

const SNAP = 2e-11;  // angle [rad], or length in sizes of the arm, that is rounding
const HALF = [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1];  // Rot_x(pi)

const turnZ = MOTION.theta, shiftZ = MOTION.d, shiftX = MOTION.a, turnX = MOTION.alpha;

function inverse(T) {
  const R = [T[0], T[4], T[8], T[1], T[5], T[9], T[2], T[6], T[10]], p = origin(T);
  const back = [0, 1, 2].map(i => -(R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2]));
  return [0, 1, 2].flatMap(i => [...R.slice(3 * i, 3 * i + 3), back[i]]).concat([0, 0, 0, 1]);
}

const product = (...matrices) => matrices.reduce(mul);

// A table as standard rows between base and tool.
function standardRows(table) {
  const rows = table.rows.map(row => ({...row})), first = rows[0];
  let {base, tool} = table;
  if (!table.standard) {
    base = product(base, turnX(first.alpha), shiftX(first.a));
    rows.forEach((row, i) => Object.assign(row, {a: rows[i + 1]?.a ?? 0, alpha: rows[i + 1]?.alpha ?? 0}));
  }
  return {base, rows, tool, lower: table.lower, upper: table.upper};
}

// The arm seen from its tool: joints in reverse order, their values the same.
function reversed({base, rows, tool, lower, upper}) {
  const n = rows.length, last = rows[n - 1];
  const back = rows.map((_, k) => {
    const row = rows[n - 1 - k], before = rows[n - 2 - k];
    return {theta: -row.theta, d: -row.d, a: -(before?.a ?? 0), alpha: -(before?.alpha ?? 0), slides: row.slides, sign: -row.sign};
  });
  const ends = {base: product(inverse(tool), turnX(-last.alpha), shiftX(-last.a)), tool: inverse(base)};
  return {...ends, rows: back, lower: [...lower].reverse(), upper: [...upper].reverse()};
}

// Links 0 ... n with T_base_tool = links[0] Z(q1) links[1] ... Z(qn) links[n], joints turned by their sign.
function linksOf({base, rows, tool}) {
  const links = [];
  let T = base;
  for (const row of rows) {
    T = product(T, turnZ(row.theta), shiftZ(row.d));
    links.push(row.sign < 0 ? mul(T, HALF) : T);
    T = product(row.sign < 0 ? HALF : I4, shiftX(row.a), turnX(row.alpha));
  }
  return [...links, mul(T, tool)];
}

// Joint frames at q = 0, z along the axes, and the tool.
function placesOf(links) {
  return links.slice(1).reduce((out, link) => [...out, mul(out[out.length - 1], link)], [links[0]]);
}

function forward(links, rows, q) {
  return rows.reduce((T, row, i) => product(T, row.slides ? shiftZ(q[i]) : turnZ(q[i]), links[i + 1]), links[0]);
}

// Lengths from axis to axis, added up, and the travel of slides.
function sizeOf(chain) {
  const places = placesOf(linksOf(chain));
  let [total, point] = [0, origin(places[0])];
  places.slice(1).forEach((T, i) => {
    const z = column(T, 2), away = add(point, origin(T), -1), along = i + 1 < chain.rows.length ? dot(away, z) : 0;
    const foot = add(origin(T), z, along);
    total += distance(foot, point);
    point = foot;
  });
  chain.rows.forEach((row, i) => {
    if (row.slides && Number.isFinite(chain.upper[i] - chain.lower[i])) total += Math.max(Math.abs(chain.lower[i]), Math.abs(chain.upper[i]), chain.upper[i] - chain.lower[i]);
  });
  return total > 1e-9 ? total : 1;
}

const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];

// Rows with what nearly vanishes put to zero, axes that are parallel pointing one way and links not
// negative; what stands on axis 1 below the arm and behind joint n belongs to base and tool.
function tidied(chain, size) {
  let {base, tool} = chain;
  const zero = v => Math.abs(v) <= SNAP * size ? 0 : v;
  const rows = chain.rows.map(row => ({...row, a: zero(row.a), d: zero(row.d), ca: Math.cos(row.alpha), sa: Math.sin(row.alpha)}));
  const last = rows[rows.length - 1];
  tool = product(shiftX(last.a), turnX(last.alpha), tool);
  Object.assign(last, {a: 0, ca: 1, sa: 0});
  rows.slice(0, -1).forEach((row, i) => {
    const after = rows.slice(i + 1);
    if (row.a < 0) {  // Tx(a) Rx(alpha) = Rz(pi) Tx(-a) Rx(-alpha) Rz(-pi)
      row.theta += Math.PI;
      after[0].theta -= Math.PI;
      [row.a, row.sa] = [-row.a, -row.sa];
    }
    if (Math.abs(row.sa) <= SNAP) {
      if (row.ca < 0) {  // Rx(pi) moves on to the tool, and turns each axis on its way
        after.forEach(next => Object.assign(next, {theta: -next.theta, d: -next.d, sign: -next.sign}));
        tool = mul(HALF, tool);
      }
      [row.ca, row.sa] = [1, 0];
      after[0].d = zero(after[0].d + row.d);
      row.d = 0;
    } else if (Math.abs(row.ca) <= 1e-12) [row.ca, row.sa] = [0, Math.sign(row.sa)];
  });
  base = product(base, turnZ(rows[0].theta), shiftZ(rows[0].d));
  tool = product(turnZ(last.theta), shiftZ(last.d), tool);
  if (rows.length > 1) Object.assign(rows[0], {theta: 0, d: 0});
  Object.assign(last, {theta: 0, d: 0});
  return {base, rows, tool};
}
