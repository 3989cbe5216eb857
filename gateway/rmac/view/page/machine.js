"use strict";
// The machine in 3D: a group for each link, in which its bodies stand as they do with all joints at 0.
const BODY_COLOURS = {machine: "#9aa3ab", fixture: "#b58b4c", stock: "#c9b48a", part: "#3d7ea6", "cutting part": "#d9a520",
  shank: "#8b9299", holder: "#50585f"};
const MET_COLOURS = ["#e02020", "#ff8c1a"];
const MOST_OF_PATH = 50000;  // points

function vector(p) { return new THREE.Vector3(p[0], p[1], p[2]); }
function quaternion(q) { return new THREE.Quaternion(q[1], q[2], q[3], q[0]); }

function geometryOf(body) {
  if (body.box) return new THREE.BoxBufferGeometry(...body.box);
  if (body.turned) {
    const outline = body.turned.map(([r, z]) => new THREE.Vector2(r, z));
    return new THREE.LatheBufferGeometry(outline, 48).rotateX(Math.PI / 2);  // it turns about y
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(body.mesh.points), 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(body.mesh.triangles), 1));
  geometry.computeVertexNormals();
  return geometry;
}

class MachineView {
  constructor(canvas) {
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, logarithmicDepthBuffer: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setClearColor("#e9edf0");
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.1, 1e6);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.render());
    const lamp = new THREE.DirectionalLight("#ffffff", 0.55);
    lamp.position.set(-0.5, 0.8, 1);
    this.camera.add(lamp);
    this.scene.add(this.camera, new THREE.HemisphereLight("#ffffff", "#8d949b", 0.75));
    this.root = new THREE.Group();
    this.scene.add(this.root);
    this.links = film.links.map(() => this.added(this.root, new THREE.Group()));
    this.meshes = film.bodies.map(body => this.addBody(body, this.links[body.link]));
    this.tools = film.tools.map(tool => {
      const group = this.added(this.links[this.links.length - 1], new THREE.Group());
      this.meshes.push(...tool.bodies.map(body => this.addBody(body, group)));
      return group;
    });
    this.addOnTable();
    this.holdTable = false;
    this.time = film.from_s;
    this.move();
  }

  added(parent, child) {
    parent.add(child);
    return child;
  }

  addBody(body, parent) {
    const seeThrough = body.kind === "stock";
    const material = new THREE.MeshPhongMaterial({color: body.colour || BODY_COLOURS[body.kind], flatShading: !body.turned,
      shininess: 12, specular: "#222222", side: THREE.DoubleSide, transparent: seeThrough, opacity: seeThrough ? 0.45 : 1,
      depthWrite: !seeThrough});
    const mesh = new THREE.Mesh(geometryOf(body), material);
    mesh.position.copy(vector(body.p)).sub(vector(film.links[body.link].middle));
    mesh.quaternion.copy(quaternion(body.q));
    mesh.userData = {body, colour: material.color.clone()};
    parent.add(mesh);
    return mesh;
  }

  /// What stands in the table's frame: what is left of the stock, the way of the tip, the place of a finding.
  addOnTable() {
    const table = this.added(this.links[0], new THREE.Group());
    table.position.copy(vector(film.links[0].middle)).negate();
    const frame = film.part_frame || {p: [0, 0, 0], q: [1, 0, 0, 0]};
    this.after = null;
    if (film.stock_after && film.stock_after.triangles.length > 0) {
      this.after = this.addBody({name: "stock", kind: "stock", link: 0, p: frame.p, q: frame.q,
        mesh: film.stock_after}, this.links[0]);
      Object.assign(this.after.material, {transparent: false, opacity: 1, depthWrite: true});
      this.after.visible = false;
    }
    this.cut = film.stocks.map(stock => {
      const mesh = this.addBody({name: "stock", kind: "stock", link: 0, p: frame.p, q: frame.q, mesh: stock}, this.links[0]);
      Object.assign(mesh.material, {transparent: false, opacity: 1, depthWrite: true});
      return mesh;
    });
    this.stock = "before";
    const way = new THREE.BufferGeometry();
    way.setAttribute("position", new THREE.BufferAttribute(this.pathOfTip(), 3));
    this.path = this.added(table, new THREE.Line(way, new THREE.LineBasicMaterial({color: "#1f6f8b"})));
    this.path.frustumCulled = false;
    const mark = new THREE.MeshBasicMaterial({color: "#ff00c8", depthTest: false, transparent: true});
    this.mark = this.added(table, new THREE.Mesh(new THREE.SphereBufferGeometry(1, 16, 12), mark));
    this.mark.renderOrder = 1;
    this.mark.visible = false;
    this.toMachine = new THREE.Matrix4().compose(vector(frame.p), quaternion(frame.q), new THREE.Vector3(1, 1, 1));
  }

  /// Moves what stands on a link from its place with all joints at 0 to that at a time.
  displacement(link, t) {
    const {p, q} = placeAt(film.links[link], t);
    const back = vector(film.links[link].middle).negate();
    return new THREE.Matrix4().compose(vector(p), quaternion(q), new THREE.Vector3(1, 1, 1))
      .multiply(new THREE.Matrix4().makeTranslation(back.x, back.y, back.z));
  }

  /// The tip as the table sees it.
  tipOnTable(t) {
    const tool = toolAt(t);
    const tip = vector(tool ? tool.tip : film.links[film.links.length - 1].middle);
    const table = new THREE.Matrix4().getInverse(this.displacement(0, t));
    return tip.applyMatrix4(this.displacement(film.links.length - 1, t)).applyMatrix4(table);
  }

  pathOfTip() {
    let times = [...new Set(film.links.flatMap(link => link.t))].sort((a, b) => a - b);
    const each = Math.ceil(times.length / MOST_OF_PATH);
    times = times.filter((_, n) => n % each === 0 || n === times.length - 1);
    const points = new Float32Array(3 * times.length);
    times.forEach((t, n) => this.tipOnTable(t).toArray(points, 3 * n));
    return points;
  }

  move() {
    film.links.forEach((link, k) => {
      const {p, q} = placeAt(link, this.time);
      this.links[k].position.copy(vector(p));
      this.links[k].quaternion.copy(quaternion(q));
    });
    const mounted = stepAt(film.tool_at, this.time);
    this.placeStock();
    this.tools.forEach((group, n) => { group.visible = n === mounted; });
    const table = this.displacement(0, this.time);
    this.root.matrixAutoUpdate = false;
    if (this.holdTable) this.root.matrix.getInverse(table); else this.root.matrix.identity();
    this.scene.updateMatrixWorld(true);
  }

  showTime(t) {
    this.time = t;
    this.move();
    this.render();
  }

  /// `which`: before, cut (as far as it is at the time), after or none.
  showStock(which) {
    this.stock = which;
    this.placeStock();
    this.render();
  }

  placeStock() {
    const times = film.stocks.map(stock => stock.t);
    const now = this.stock === "cut" && times.length > 0 && times[0] <= this.time ? keyBefore(times, this.time) : -1;
    this.cut.forEach((mesh, n) => { mesh.visible = n === now; });
    const whole = this.stock === "before" || (this.stock === "cut" && now < 0);
    for (const mesh of this.meshes) {
      if (mesh.userData.body.kind === "stock") mesh.visible = whole;
    }
    if (this.after) this.after.visible = this.stock === "after";
  }

  /// Where a finding is, as the table sees it.
  placeOf(finding) {
    return finding.place_mm ? vector(finding.place_mm).applyMatrix4(this.toMachine) : this.tipOnTable(finding.at_s);
  }

  /// Colours the bodies of these names, each its own way, and marks the place as the table sees it; nothing: as they are.
  colour(names, place) {
    for (const mesh of [...this.meshes, ...this.cut, ...(this.after ? [this.after] : [])]) {
      const n = names.indexOf(mesh.userData.body.name);
      mesh.material.color.copy(n < 0 ? mesh.userData.colour : new THREE.Color(MET_COLOURS[n % 2]));
      mesh.userData.met = n >= 0;
    }
    this.mark.visible = Boolean(place);
    if (place) this.mark.position.copy(place);
    this.render();
  }

  /// Turns the camera to bodies that pass a test, from where it looks already.
  lookAt(test) {
    const box = new THREE.Box3();
    for (const mesh of this.meshes) {
      if (test(mesh.userData.body) && mesh.parent.visible) box.expandByObject(mesh);
    }
    if (box.isEmpty()) return;
    const ball = box.getBoundingSphere(new THREE.Sphere());
    const from = this.camera.position.clone().sub(this.controls.target);
    if (from.length() === 0) from.set(-0.55, -1, 0.55);
    const half = Math.min(this.camera.fov, this.camera.fov * this.camera.aspect) * Math.PI / 360;
    from.setLength(1.05 * ball.radius / Math.sin(half));
    this.controls.target.copy(ball.center);
    this.camera.position.copy(ball.center).add(from);
    this.controls.update();
    this.render();
  }

  resize(width, height) {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.render();
  }

  render() {
    // Seen from wherever, the mark is as large.
    const far = this.camera.position.distanceTo(this.mark.getWorldPosition(new THREE.Vector3()));
    this.mark.scale.setScalar(0.006 * far);
    this.renderer.render(this.scene, this.camera);
  }
}
