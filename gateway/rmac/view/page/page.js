"use strict";
// The page about the machine: time, findings, and what is shown.
const $ = id => document.getElementById(id);
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 25, 100];
const START_SPEED = 1;
const MOST_LISTED = 2000;

function element(kind, text) {
  const made = document.createElement(kind);
  made.textContent = text;
  return made;
}

const page = {
  time: film.from_s,
  playing: false,
  chosen: -1,
  view: null,
  plots: null,

  goTo(t) {
    this.time = Math.min(Math.max(t, film.from_s), film.to_s);
    if (this.view) this.view.showTime(this.time);
    this.plots.show(this.time);
    $("time").value = this.time;
    $("clock").value = `${this.time.toFixed(3)} of ${film.to_s.toFixed(3)} s`;
    const tool = toolAt(this.time), limit = film.limits.names[stepAt(film.limits, this.time)];
    $("now").textContent = [`line ${stepAt(film.lines, this.time)}`,
      tool ? (tool.number ? `tool ${tool.number} ${tool.name}`.trim() : "no tool") : "",
      limit ? (limit === "none" ? "ruled by none" : `ruled by ${limit}`) : "at rest",
      ...plotRows.map(row => mostAt(row, this.time))]
      .filter(Boolean).join(" · ");
    $("now").title = $("now").textContent;
  },

  choose(n) {
    const finding = findings[n];
    for (const button of $("findings").querySelectorAll("button")) button.toggleAttribute("aria-current", Number(button.dataset.n) === n);
    this.chosen = n;
    this.play(false);
    this.goTo(finding.at_s);
    if (this.view) this.view.colour(finding.bodies, this.view.placeOf(finding));
  },

  play(on) {
    if (on && this.time >= film.to_s) this.goTo(film.from_s);
    this.playing = on;
    $("play").textContent = on ? "pause" : "play";
    let before = null;
    const step = now => {
      if (!this.playing) return;
      if (before !== null) this.goTo(this.time + (now - before) / 1000 * Number($("speed").value));
      before = now;
      if (this.time >= film.to_s) this.play(false); else requestAnimationFrame(step);
    };
    if (on) requestAnimationFrame(step);
  },

  listFindings() {
    findings.slice(0, MOST_LISTED).forEach((finding, n) => {
      const told = finding.text + (finding.why ? ` (${finding.why})` : "");
      const button = element("button", finding.kind + ": " + [finding.bodies.join(" × "), told, finding.at_s.toFixed(3) + " s",
        finding.line > 0 ? "line " + finding.line : "before the program"].filter(Boolean).join(" · "));
      button.style.setProperty("--mark", finding.colour);
      button.dataset.n = n;
      button.addEventListener("click", () => this.choose(n));
      $("findings").append(document.createElement("li"));
      $("findings").lastChild.append(button);
    });
    if (!film.checked) $("findings").append(element("li", "collisions are not checked: no --setup was named"));
    else if (findings.length === 0) $("findings").append(element("li", "none"));
    if (findings.length > MOST_LISTED) $("findings").append(element("li", `${findings.length - MOST_LISTED} more stand on the line of findings alone`));
  },

  /// The limits that rule, those for the longest time first.
  listLimits() {
    const {t, is, names} = film.limits, time = names.map(() => 0);
    t.forEach((from, i) => { time[is[i]] += (i + 1 < t.length ? t[i + 1] : film.to_s) - from; });
    const order = names.map((_, n) => n).filter(n => names[n] !== "").sort((a, b) => time[b] - time[a]);
    $("limits").append(...order.map(n => {
      const item = element("li", `${names[n]} ${figure(time[n])} s`);
      item.style.setProperty("--mark", this.plots.colours[n]);
      return item;
    }));
  },

  listNotes() {
    const notes = [...(film.not_checked || []).map(text => "NOT CHECKED: " + text),
      ...[...(film.forces_not_told || []), ...(dynamics.not_told || [])].map(text => "NOT TOLD: " + text),
      ...film.not_shown.map(text => "NOT SHOWN: " + text)];
    if (dynamics.keeps_at_percent) notes.push(`At a feed override of ${figure(dynamics.keeps_at_percent)} % the axes keep to the program.`);
    if (film.findings_left_off > 0) notes.push(`${film.findings_left_off} findings were too many to keep`);
    if (film.meshes_coarser_mm > 0) notes.push(`Meshes are drawn coarser than they are, by up to ${figure(film.meshes_coarser_mm)} mm.`);
    if (film.within_mm > 0.05) notes.push(`So long a program is shown to ${figure(film.within_mm)} mm.`);
    if (film.stock_after && film.stock_after.triangles.length === 0) notes.push("Nothing is left of the stock that its rays show.");
    $("notes").append(...notes.map(text => element("li", text)));
  },

  listBodies() {
    const names = [...new Set(this.view.meshes.filter(mesh => mesh.userData.body.kind !== "stock").map(mesh => mesh.userData.body.name))];
    for (const name of names) {
      const label = element("label", " " + name), box = document.createElement("input");
      box.type = "checkbox";
      box.checked = true;
      box.addEventListener("change", () => {
        for (const mesh of this.view.meshes) if (mesh.userData.body.name === name) mesh.visible = box.checked;
        this.view.render();
      });
      label.prepend(box);
      label.title = name;
      $("bodies").append(document.createElement("li"));
      $("bodies").lastChild.append(label);
    }
  },

  connectView() {
    const view = this.view, onTable = ["fixture", "stock", "part"], ofTool = ["cutting part", "shank", "holder"];
    const hasTable = film.bodies.some(body => onTable.includes(body.kind));
    const nearTable = body => hasTable ? onTable.includes(body.kind) || ofTool.includes(body.kind) : body.link === 0;
    $("look-machine").addEventListener("click", () => view.lookAt(() => true));
    $("look-table").addEventListener("click", () => view.lookAt(nearTable));
    $("look-tool").addEventListener("click", () => view.lookAt(body => ofTool.includes(body.kind)));
    $("hold-table").addEventListener("change", event => { view.holdTable = event.target.checked; view.showTime(this.time); });
    $("path").addEventListener("change", event => { view.path.visible = event.target.checked; view.render(); });
    for (const radio of document.getElementsByName("stock")) radio.addEventListener("change", () => view.showStock(radio.value));
    if (!film.bodies.some(body => body.kind === "stock")) $("stock").hidden = true;
    if (film.stocks.length > 0) document.querySelector("#stock [value=cut]").click();
    this.listBodies();
    view.lookAt(() => true);
  },

  resize() {
    const box = $("scene").getBoundingClientRect();
    if (this.view) this.view.resize(box.width, box.height);
    this.plots.redraw();
  },

  begin() {
    $("title").textContent = document.title = `${film.program} on ${film.machine}`;
    this.listNotes();
    this.listFindings();
    this.plots = new Plots($("plots"), t => this.goTo(t));
    this.listLimits();
    for (const speed of SPEEDS) $("speed").append(new Option(`${speed} ×`, speed, false, speed === START_SPEED));
    Object.assign($("time"), {min: film.from_s, max: film.to_s});
    $("time").addEventListener("input", event => this.goTo(Number(event.target.value)));
    $("play").addEventListener("click", () => this.play(!this.playing));
    addEventListener("keydown", event => {
      if (event.code !== "Space" || event.target.tagName === "BUTTON") return;
      event.preventDefault();
      this.play(!this.playing);
    });
    try {
      this.view = new MachineView($("canvas"));
    } catch (error) {
      // The findings and plots are there without it.
      errors.push(String(error));
      $("trouble").textContent = `This browser cannot draw in 3D (${error.message}). It needs WebGL.`;
      $("trouble").hidden = false;
    }
    this.resize();
    if (this.view) this.connectView();
    addEventListener("resize", () => this.resize());
    this.goTo(film.from_s);
    const asked = new URLSearchParams(location.hash.slice(1));
    if (asked.has("stock") && this.view) {
      const radio = [...document.getElementsByName("stock")].find(each => each.value === asked.get("stock"));
      if (radio) radio.click();
    }
    const t = parseFloat(asked.get("t"));
    if (!Number.isNaN(t)) this.goTo(t);
    const finding = Number(asked.get("finding") ?? NaN);
    if (Number.isInteger(finding) && findings[finding]) this.choose(finding);
    if (asked.has("look") && this.view) $("look-" + asked.get("look"))?.click();
  },
};
page.begin();
