"use strict";
// Time runs from left to right under the machine: findings, the limit that rules, and what was plotted.
const LEFT = 110;  // px, of the names
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
      ...film.plots.map(plot => ({height: 44, name: plot.name, unit: plot.unit, draw: (pen, w, h) => this.drawPlot(pen, w, h, plot)})),
    ];
    for (const row of this.rows) {
      row.canvas = document.createElement("canvas");
      row.canvas.style.height = row.height + "px";
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
      row.draw(pen, this.width, row.height);
      pen.clearRect(0, 0, LEFT, row.height);
      pen.fillStyle = "#50585f";
      pen.fillText(row.name + (row.unit ? ", " + row.unit : ""), 2, row.height < 22 ? 12 : 16);
      if (row.most !== undefined) pen.fillText(figure(row.most), 2, 36);
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
      pen.fillStyle = KIND_COLOURS[finding.kind];
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

  drawPlot(pen, width, height, plot) {
    let most = 0;
    for (const value of plot.is) most = Math.max(most, Math.abs(value));
    const row = this.rows.find(each => each.name === plot.name);
    row.most = most;
    const least = plot.is.some(value => value < 0) ? -most : 0;
    const y = value => height - 2 - (height - 4) * (value - least) / (most - least || 1);
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
    pen.strokeStyle = "#2a6f97";
    pen.stroke();
  }
}
