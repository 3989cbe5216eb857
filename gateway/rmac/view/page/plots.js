"use strict";
// Time runs from left to right under the machine: findings, the limit that rules, and what was plotted.
const LEFT = 130;  // px, of the names
const TALL = 44, LOW = 30, MOST_TALL = 6;  // px of a plot; of so many at most, and of several in one
const CURVE_COLOURS = ["#2a6f97", "#c1542b", "#3f8f4f", "#8a4fbf", "#b08a1e", "#2f9c95", "#c2187a", "#66707a"];
const LEVEL_COLOUR = "#a02020", MOST_BEYOND = 2;
const NONE_COLOURS = {"": "#ffffff", none: "#e3e6e8", feed: "#5aa469", "path acceleration": "#2f9c95"};
const QUANTITY_COLOURS = {velocity: [215, 55], acceleration: [32, 55], jerk: [350, 55]};

/// One hue a quantity, one lightness a joint.
function limitColours(names) {
  const joints = [...new Set(names.filter(n => !(n in NONE_COLOURS)).map(n => n.replace(/ \w+$/, "")))].sort();
  return names.map(name => {
    if (name in NONE_COLOURS) return NONE_COLOURS[name];
    const [hue, saturation] = QUANTITY_COLOURS[name.split(" ").pop()] || [0, 0];
    const joint = joints.indexOf(name.replace(/ \w+$/, ""));
    return `hsl(${hue}, ${saturation}%, ${38 + 40 * joint / Math.max(joints.length, 1)}%)`;
  });
}

function curveColour(n) { return CURVE_COLOURS[n % CURVE_COLOURS.length]; }

/// How far up and down a row goes, the levels that it shows, and those that lie so far beyond that they are only named.
function scaleOf({curves}) {
  let most = 0, negative = false;
  for (const plot of curves) {
    for (const value of plot.is) {
      most = Math.max(most, Math.abs(value));
      negative = negative || value < 0;
    }
  }
  const all = [];
  curves.forEach((plot, n) => {
    for (const {name, is} of plot.levels) {
      const same = all.find(level => level.name === name && level.is === is);
      if (same) same.colour = LEVEL_COLOUR; else all.push({name, is, colour: curves.length > 1 ? curveColour(n) : LEVEL_COLOUR});
    }
  });
  const levels = all.filter(level => level.is <= MOST_BEYOND * most), beyond = all.filter(level => level.is > MOST_BEYOND * most);
  most = levels.reduce((top, level) => Math.max(top, level.is), most);
  return {most, least: negative ? -most : 0, levels, beyond};
}

class Plots {
  constructor(parent, goTo) {
    this.parent = parent;
    this.goTo = goTo;
    this.from = film.from_s;
    this.to = Math.max(film.to_s, film.from_s + 1e-3);
    this.colours = limitColours(film.limits.names);
    this.rows = [
      {height: 15, name: "findings", draw: (pen, w, h) => this.drawFindings(pen, w, h)},
      {height: 15, name: "ruled by", draw: (pen, w, h) => this.drawLimits(pen, w, h)},
      ...plotRows.map(row => ({...row, ...scaleOf(row), height: plotRows.length > MOST_TALL && row.curves.length === 1 ? LOW : TALL,
        draw: (pen, w, h, made) => this.drawPlot(pen, w, h, made)})),
    ];
    for (const row of this.rows) {
      row.canvas = document.createElement("canvas");
      row.canvas.style.height = row.height + "px";
      if (row.curves) row.canvas.title = row.curves.map(plot => `${plot.name} within ${figure(plot.within)} ${plot.unit}`).join("\n");
      row.drawn = document.createElement("canvas");
      parent.append(row.canvas);
    }
    let pressed = false;
    const go = event => this.goTo(this.timeAt(event.clientX));
    parent.addEventListener("pointerdown", event => { pressed = true; go(event); });
    addEventListener("pointermove", event => { if (pressed) go(event); });
    addEventListener("pointerup", () => { pressed = false; });
    parent.addEventListener("dblclick", () => this.zoom(film.from_s, Math.max(film.to_s, film.from_s + 1e-3)));
    parent.addEventListener("wheel", event => {
      event.preventDefault();
      const t = this.timeAt(event.clientX), factor = event.deltaY > 0 ? 1.25 : 0.8;
      this.zoom(t - (t - this.from) * factor, t + (this.to - t) * factor);
    }, {passive: false});
  }

  zoom(from, to) {
    if (to - from < 1e-3) return;
    this.from = Math.max(from, film.from_s);
    this.to = Math.min(to, Math.max(film.to_s, film.from_s + 1e-3));
    this.redraw();
  }

  x(t) { return LEFT + (this.width - LEFT) * (t - this.from) / (this.to - this.from); }

  timeAt(clientX) {
    const box = this.parent.getBoundingClientRect();
    const t = this.from + (clientX - box.left - LEFT) / (box.width - LEFT) * (this.to - this.from);
    return Math.min(Math.max(t, film.from_s), film.to_s);
  }

  redraw() {
    this.width = this.parent.clientWidth;
    const ratio = window.devicePixelRatio || 1;
    for (const row of this.rows) {
      for (const canvas of [row.canvas, row.drawn]) {
        canvas.width = this.width * ratio;
        canvas.height = row.height * ratio;
      }
      const pen = row.drawn.getContext("2d");
      pen.scale(ratio, ratio);
      pen.font = "11px sans-serif";
      pen.fillStyle = "#fafbfb";
      pen.fillRect(LEFT, 1, this.width - LEFT, row.height - 2);
      row.draw(pen, this.width, row.height, row);
      pen.clearRect(0, 0, LEFT, row.height);
      pen.fillStyle = "#50585f";
      pen.fillText(row.name + (row.unit ? ", " + row.unit : ""), 2, row.height < 40 ? 12 : 16);
      if (row.curves) this.nameCurves(pen, row);
    }
    this.show(this.time || this.from);
  }

  show(t) {
    this.time = t;
    for (const row of this.rows) {
      const pen = row.canvas.getContext("2d"), ratio = window.devicePixelRatio || 1;
      pen.clearRect(0, 0, row.canvas.width, row.canvas.height);
      pen.drawImage(row.drawn, 0, 0);
      pen.fillStyle = "#c02020";
      if (t >= this.from && t <= this.to) pen.fillRect(this.x(t) * ratio - 0.5, 0, ratio, row.canvas.height);
    }
  }

  drawFindings(pen, width, height) {
    for (const finding of findings) {
      pen.fillStyle = finding.colour;
      const from = this.x(finding.t_s);
      pen.fillRect(from, 1, Math.max(this.x(finding.until_s) - from, 2), height - 2);
    }
  }

  drawLimits(pen, width, height) {
    const {t, is} = film.limits;
    for (let i = 0; i < t.length; ++i) {
      const from = this.x(t[i]), to = this.x(i + 1 < t.length ? t[i + 1] : film.to_s);
      if (to < LEFT || from > width) continue;
      pen.fillStyle = this.colours[is[i]];
      pen.fillRect(from, 1, to - from + 0.3, height - 2);
    }
  }

  drawPlot(pen, width, height, {curves, most, least, levels, beyond}) {
    const y = value => height - 2 - (height - 4) * (value - least) / (most - least || 1);
    pen.setLineDash([6, 4]);
    for (const {is, colour} of levels) {
      pen.strokeStyle = colour;
      for (const value of least < 0 ? [is, -is] : [is]) {
        pen.beginPath();
        pen.moveTo(LEFT, y(value));
        pen.lineTo(width, y(value));
        pen.stroke();
      }
    }
    pen.setLineDash([]);
    curves.forEach((plot, n) => this.drawCurve(pen, plot, y, curveColour(n)));
    const told = [...levels.map(({name, is, colour}) => ({text: `- - ${name} ${figure(is)}`, colour})),
      ...beyond.map(({name, is, colour}) => ({text: `${name} ${figure(is)} ↑`, colour}))];
    let x = width - 4;
    for (const {text, colour} of told.reverse()) {
      x -= pen.measureText(text).width;
      pen.fillStyle = colour;
      pen.fillText(text, x, 12);
      x -= 10;
    }
  }

  /// What a row goes up to, and its curves, where there are several, by what tells them apart.
  nameCurves(pen, {curves, most, least, height}) {
    const first = curves[0].name.replace(/[^ ]*$/, ""), common = curves.every(plot => plot.name.startsWith(first)) ? first.length : 0;
    let x = 2;
    const write = (text, colour) => {
      pen.fillStyle = colour;
      pen.fillText(text, x, height - 8);
      x += pen.measureText(text + "  ").width;
    };
    write((least < 0 ? "±" : "") + figure(most), "#50585f");
    if (curves.length > 1) curves.forEach((plot, n) => write(plot.name.slice(common), curveColour(n)));
  }

  drawCurve(pen, plot, y, colour) {
    pen.beginPath();
    // Keys that share a pixel leave the highest and the lowest of them.
    let column = null, low = 0, high = 0, last = 0;
    const flush = () => { pen.lineTo(column, y(low)); pen.lineTo(column, y(high)); pen.lineTo(column, y(last)); };
    for (let i = 0; i < plot.t.length; ++i) {
      const at = Math.round(2 * this.x(plot.t[i])) / 2, value = plot.is[i];
      if (at !== column) {
        if (column !== null) flush();
        pen.lineTo(at, y(value));
        column = at;
        low = high = value;
      }
      low = Math.min(low, value);
      high = Math.max(high, value);
      last = value;
    }
    if (column !== null) flush();
    pen.strokeStyle = colour;
    pen.stroke();
  }
}
