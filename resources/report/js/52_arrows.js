// Arrows in the three-dimensional view: a shaft and a head each.
class ArrowMesh {
  constructor(scene, count) {
    const faces = [0, 1, 2, 0, 2, 1, 0, 1, 5, 1, 2, 5, 2, 0, 5, 3, 4, 5, 4, 3, 6, 3, 5, 6, 5, 4, 6], corners = 7, index = [];
    for (let i = 0; i < count; ++i) for (const f of faces) index.push(corners * i + f);
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setIndex(index);
    this.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * corners * count), 3));
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({ side: THREE.DoubleSide }));
    this.mesh.frustumCulled = false;
    scene.add(this.mesh);
  }

  set(i, from, along, length, width) {
    const out = this.geometry.attributes.position.array;
    const other = Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const side = new THREE.Vector3(...along).cross(new THREE.Vector3(...other)).normalize();
    const up = new THREE.Vector3(...along).cross(side);
    const corner = (c, far, wide, turn) => {
      const s = wide * Math.cos(turn), u = wide * Math.sin(turn);
      for (let a = 0; a < 3; ++a) out[21 * i + 3 * c + a] = from[a] + far * along[a] + s * side.getComponent(a) + u * up.getComponent(a);
    };
    const third = (2 * Math.PI) / 3;
    for (let c = 0; c < 3; ++c) {
      corner(c, 0, 0.35 * width, c * third);
      corner(3 + c, 0.62 * length, width, c * third);
    }
    corner(6, length, 0, 0);
  }

  finish() {
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
  }
}

// The missing force: from where it acts.
class MissingForce {
  constructor(scene, rest, size) {
    const { time, places, field } = page.arrows;
    this.time = time;
    this.places = shorts(places);
    this.field = shorts(field);
    this.count = this.places.length / 3;
    this.longest = 0.22 * size;
    const strengths = Float64Array.from({ length: this.field.length / 3 }, (x, i) => Math.hypot(...this.field.slice(3 * i, 3 * i + 3)));
    this.most = quantile(strengths, 0.98) || 1;
    this.vertex = Array.from({ length: this.count }, (x, i) => nearestVertex(rest, this.places.subarray(3 * i, 3 * i + 3)));
    this.arrows = new ArrowMesh(scene, this.count);
    this.mesh = this.arrows.mesh;
    $("arrow-scale").textContent = "(longest: " + withUnit(this.most, "N/kg", 2) + ")";
  }

  show(time, surface) {
    this.mesh.visible = $("arrows").checked && player.replay === replays[0];
    if (!this.mesh.visible) return;
    const k = nearest(this.time, time);
    for (let i = 0; i < this.count; ++i) {
      const f = [0, 1, 2].map((a) => this.field[3 * (k * this.count + i) + a]);
      const strength = Math.hypot(...f) || 1e-30, share = strength / this.most;
      const from = surface.subarray(3 * this.vertex[i], 3 * this.vertex[i] + 3);
      this.arrows.set(i, from, f.map((x) => x / strength), this.longest * Math.min(1.5, share),
        0.09 * this.longest * Math.min(1, Math.sqrt(share)));
    }
    this.arrows.finish();
  }
}

function nearestVertex(points, to) {
  let best = 0, least = Infinity;
  for (let v = 0; v < points.length / 3; ++v) {
    const far = [0, 1, 2].reduce((sum, a) => sum + (points[3 * v + a] - to[a]) ** 2, 0);
    if (far < least) { least = far; best = v; }
  }
  return best;
}
