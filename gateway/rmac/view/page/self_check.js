"use strict";
// Opened with #self-check, the page tells in its document what it drew: for programs that test it.
function selfCheck() {
  const view = page.view, report = {errors, bodies: film.bodies.length, drawn: 0};
  report.notes = [...$("notes").children].map(note => note.textContent);
  report.rows = page.plots.rows.filter(row => row.curves).map(({name, unit, curves, most, levels, beyond}) =>
    ({name, unit, curves: curves.map(plot => plot.name), most, levels: levels.map(each => each.name), beyond: beyond.map(each => each.name)}));
  if (view) {
    view.render();
    Object.assign(report, {drawn: view.renderer.info.render.calls, triangles: view.renderer.info.render.triangles, meshes: view.meshes.length});
    // Each finding is clicked on, and seen to.
    report.findings = [...$("findings").querySelectorAll("button")].map(button => {
      button.click();
      const met = view.meshes.filter(mesh => mesh.userData.met && mesh.parent.visible);
      return {time: page.time, text: button.textContent, coloured: [...new Set(met.map(mesh => mesh.userData.body.name))],
        mark: view.mark.getWorldPosition(new THREE.Vector3()).toArray()};
    });
    view.colour([], null);
    // Where a point of each body is, through the scene as it is drawn.
    report.places = [];
    for (let n = 0; n <= 20; ++n) {
      const t = film.from_s + (film.to_s - film.from_s) * n / 20;
      page.goTo(t);
      const at = view.meshes.filter(mesh => mesh.parent.visible).map(mesh => ({name: mesh.userData.body.name,
        corner: mesh.localToWorld(new THREE.Vector3(10, 20, 30)).toArray()}));
      report.places.push({t, bodies: at, tip: view.tipOnTable(t).toArray()});
    }
  }
  const text = element("pre", JSON.stringify(report));
  text.id = "self-check";
  text.hidden = true;
  document.body.append(text);
}
if (new URLSearchParams(location.hash.slice(1)).has("self-check")) selfCheck();
