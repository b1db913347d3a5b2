// The ground, the light, the camera, and where a click meets the ground.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(42, 1, 0.05, 200);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  private readonly ground: THREE.Mesh;
  private readonly marker: THREE.Mesh;
  private readonly sun = new THREE.DirectionalLight("#fff4e2", 2.4);

  constructor() {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    document.body.append(this.renderer.domElement);
    this.scene.background = new THREE.Color("#e8edf2");
    this.scene.fog = new THREE.Fog("#e8edf2", 16, 42);
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(120, 120), new THREE.MeshStandardMaterial({ color: "#dfe5ea", roughness: 1 }));
    this.ground.rotation.x = -Math.PI / 2;
    this.ground.receiveShadow = true;
    const grid = new THREE.GridHelper(120, 120, "#93a5b6", "#b4c2cf");
    grid.position.y = 0.008;
    this.marker = new THREE.Mesh(new THREE.RingGeometry(0.16, 0.22, 40), new THREE.MeshBasicMaterial({ color: "#f0a93b" }));
    this.marker.rotation.x = -Math.PI / 2;
    this.marker.position.y = 0.012;
    this.marker.visible = false;
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1536, 1536);
    Object.assign(this.sun.shadow.camera, { left: -9, right: 9, top: 9, bottom: -9, far: 40 });
    this.sun.shadow.bias = -0.0006;
    this.scene.add(this.ground, grid, this.marker, new THREE.HemisphereLight("#ffffff", "#b8c2cc", 1.5), this.sun, this.sun.target);
    this.camera.position.set(3.6, 2.6, 5.2);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.target.set(0, 0.9, 0);
    this.controls.maxPolarAngle = 1.5;
    this.controls.enableDamping = true;
    this.look(0, 0);
    addEventListener("resize", () => this.fit());
    this.fit();
  }

  fit(): void {
    this.renderer.setSize(innerWidth, innerHeight);
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
  }

  /** Let camera and light follow a place. */
  look(x: number, z: number): void {
    const [dx, dz] = [x - this.controls.target.x, z - this.controls.target.z];
    this.controls.target.add(new THREE.Vector3(0.06 * dx, 0, 0.06 * dz));
    this.camera.position.add(new THREE.Vector3(0.06 * dx, 0, 0.06 * dz));
    this.sun.target.position.set(this.controls.target.x, 0, this.controls.target.z);
    this.sun.position.copy(this.sun.target.position).add(new THREE.Vector3(4, 9, 5));
  }

  mark(x: number, z: number): void {
    this.marker.position.set(x, 0.012, z);
    this.marker.visible = true;
  }

  /** Call back with x and z of clicks that are no drags. */
  onGround(then: (x: number, z: number) => void): void {
    let down = [0, 0];
    const canvas = this.renderer.domElement;
    canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerup", (event) => {
      if (event.button !== 0 || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return;
      const ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2((event.clientX / innerWidth) * 2 - 1, 1 - (event.clientY / innerHeight) * 2), this.camera);
      const hit = ray.intersectObject(this.ground)[0];
      if (hit) then(hit.point.x, hit.point.z);
    });
  }

  draw(): void {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
  }
}
