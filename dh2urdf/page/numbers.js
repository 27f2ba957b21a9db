// Numbers as a reader wants them: in one unit, short, noise as zero, all digits on hover.

const SCALES = {m: 1, mm: 1000, rad: 1, "°": 180 / Math.PI, "": 1};
const DIGITS = {m: 6, mm: 3, rad: 5, "°": 3, "": 4};
const TINY = 1e-9;
const MINUS = "\u2212";
const KINDS = {theta: "angle", d: "length", a: "length", alpha: "angle"};

// Name of the unit chosen for lengths or angles; plain numbers have none.
function unitOf(kind) {
  const [length, angle] = document.getElementById("units").value.split(", ");
  return {length, angle}[kind] ?? "";
}

const kindOf = joint => joint.slides ? "length" : "angle";

// Rounded in the unit chosen, without a negative zero.
function rounded(value, kind, digits) {
  const unit = unitOf(kind), power = 10 ** (digits ?? DIGITS[unit]);
  return Math.abs(value) < TINY ? 0 : Math.round(value * SCALES[unit] * power) / power + 0;
}

const typeset = value => String(value).replace(/-/g, MINUS);

function text(value, kind) {
  const unit = unitOf(kind);
  return typeset(rounded(value, kind)) + (unit === "°" || !unit ? unit : ` ${unit}`);
}

function element(tag, content, attributes = {}) {
  const made = Object.assign(document.createElement(tag), attributes);
  made.append(...[content].flat());
  return made;
}

// A cell whose digits that are not shown appear on hover; ``shown`` is written instead.
function cell(value, kind = "", digits = undefined, shown = undefined) {
  const exact = typeset(value * SCALES[unitOf(kind)]), short = typeset(rounded(value, kind, digits));
  const noise = short === "0" && exact !== "0" && Math.abs(value) < TINY;
  const made = element("span", shown ?? short, {className: `${(shown ?? short) === "0" ? "zero" : ""} ${noise ? "noise" : ""}`});
  if (exact !== short) made.title = exact;
  return element("td", made);
}

// A matrix, lengths in its last column.
function matrix(T) {
  const rows = [0, 1, 2, 3].map(i => element("tr", [0, 1, 2, 3].map(j => {
    const length = j === 3 && i < 3;
    return cell(T[4 * i + j], length ? "length" : "", length && unitOf("length") === "mm" ? 2 : 4);
  })));
  return element("table", element("tbody", rows), {className: "matrix"});
}

const subscripts = i => String(i).replace(/\d/g, c => "₀₁₂₃₄₅₆₇₈₉"[c]);
