"use strict";
// What the page shows, and what of it holds at a time. Places in mm, turns as quaternions [w, x, y, z], times in s.
const film = JSON.parse(document.getElementById("film").textContent);

/// The last of ascending times that is not after t; the first where all are.
function keyBefore(times, t) {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  return low;
}

/// Where the middle of a link is, and how the link is turned against where it stands with all joints at 0.
function placeAt(link, t) {
  const i = keyBefore(link.t, t), j = Math.min(i + 1, link.t.length - 1);
  const span = link.t[j] - link.t[i];
  const share = span > 0 ? Math.min(Math.max((t - link.t[i]) / span, 0), 1) : 0;
  const p = [0, 1, 2].map(a => link.p[3 * i + a] + share * (link.p[3 * j + a] - link.p[3 * i + a]));
  return {p, q: turnBetween(link.q.slice(4 * i, 4 * i + 4), link.q.slice(4 * j, 4 * j + 4), share)};
}

/// The shorter way round, at an even rate.
function turnBetween(a, b, share) {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine *= sign;
  const angle = Math.acos(Math.min(cosine, 1)), sine = Math.sin(angle);
  const ofA = sine > 1e-6 ? Math.sin((1 - share) * angle) / sine : 1 - share;
  const ofB = sign * (sine > 1e-6 ? Math.sin(share * angle) / sine : share);
  const q = a.map((c, n) => ofA * c + ofB * b[n]);
  const length = Math.hypot(...q);
  return q.map(c => c / length);
}

/// What holds then; undefined where nothing does yet.
function stepAt(track, t) {
  return track.is[keyBefore(track.t, t)];
}

function valueAt(plot, t) {
  const i = keyBefore(plot.t, t), j = Math.min(i + 1, plot.t.length - 1), span = plot.t[j] - plot.t[i];
  const share = span > 0 ? Math.min(Math.max((t - plot.t[i]) / span, 0), 1) : 0;
  return plot.is[i] + share * (plot.is[j] - plot.is[i]);
}

/// With about three digits.
function figure(value) {
  return Math.abs(value) >= 1000 ? value.toFixed(0) : String(Number(value.toPrecision(3)));
}

function toolAt(t) {
  return film.tools[stepAt(film.tool_at, t)];
}

/// Plots that are drawn in one: of one row and one unit.
const plotRows = [];
for (const plot of film.plots) {
  const row = plotRows.find(each => each.name === plot.row && each.unit === plot.unit);
  if (row) row.curves.push(plot); else plotRows.push({name: plot.row, unit: plot.unit, curves: [plot]});
}

/// Of a row the value that is the most then, and whose it is where there are several.
function mostAt({name, unit, curves}, t) {
  const values = curves.map(plot => valueAt(plot, t));
  const n = values.reduce((best, value, i) => Math.abs(value) > Math.abs(values[best]) ? i : best, 0);
  return `${name} ${curves.length > 1 ? curves[n].name + " " : ""}${figure(values[n])} ${unit}`;
}
