// Camera, light, floor: what stands around a scene.
import {
  ACESFilmicToneMapping,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  Fog,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  Quaternion,
  Scene,
  ShadowMaterial,
  Sphere,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const SLOW = 50; // ms between two pictures; beyond, they are drawn with fewer pixels
const FEWEST_PIXELS = 0.5; // for each of the page's, along a line
const JUDGED = 12; // pictures in a row

const OBLIQUE = new Vector3(0.85, 0.55, 1);

/** The next of 1, 2, 5, 10, ... at or above `value`. */
export function roundUp(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 5, 10].find((s) => s * power >= value * (1 - 1e-9)) as number;
  return step * power;
}

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(38, 1, 0.001, 10);
  controls: OrbitControls;
  readonly renderer: WebGLRenderer;
  /** m between two lines of the floor. */
  gridStep = 0.01;
  /** Pictures drawn since the start. */
  pictures = 0;
  private readonly hemisphere = new HemisphereLight('#ffffff', '#8a8f98', 1.5);
  private readonly sun = new DirectionalLight('#ffffff', 2.2);
  private readonly floor = new Group();
  private readonly shadow = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ opacity: 0.22 }));
  private grid: LineSegments<BufferGeometry, LineBasicMaterial> | undefined;
  private gridColour = '#000000';
  private pixelRatio = Math.min(window.devicePixelRatio, 2);
  private last = 0; // ms, of the latest picture; 0: the one before was not drawn
  private inRow = 0; // pictures
  private taken = 0; // ms, by these
  private bounds = new Sphere(new Vector3(), 0.1);
  private up = new Vector3(0, 1, 0);
  private wanted = true;

  /** `adapts`: where pictures are slow, they get coarser. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly adapts: boolean,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = 1.05;
    this.controls = this.makeControls();
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 7;
    this.sun.shadow.bias = -0.0005;
    this.shadow.receiveShadow = true;
    this.shadow.raycast = () => undefined;
    this.floor.add(this.shadow);
    this.scene.add(this.hemisphere, this.sun, this.sun.target, this.floor);
  }

  private makeControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.addEventListener('change', () => this.draw());
    return controls;
  }

  /** A picture is drawn soon. */
  draw(): void {
    this.wanted = true;
  }

  /** Colours by the page's style: background and lines of the floor. */
  colour(background: string, grid: string, dark: boolean): void {
    this.scene.background = new Color(background);
    this.scene.fog = new Fog(background, 1, 2);
    this.gridColour = grid;
    this.hemisphere.intensity = dark ? 1.1 : 1.7;
    this.sun.intensity = dark ? 1.7 : 2.1;
    this.shadow.material.opacity = dark ? 0.4 : 0.18;
    this.layFloor();
    this.fogAround();
    this.draw();
  }

  /** Everything in `bounds` fits into the picture; `up` is away from the floor. */
  frame(bounds: Sphere, up: Vector3): void {
    this.bounds = bounds.clone();
    this.up = up.clone();
    this.camera.up.copy(up);
    this.layFloor();
    this.resetCamera();
  }

  /** Looks at all of the scene from there: x right, y up, z towards the reader. */
  resetCamera(from = OBLIQUE): void {
    const { center, radius } = this.bounds;
    const upright = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), this.up);
    const towards = from.clone().normalize().applyQuaternion(upright);
    const half = (Math.min(this.camera.fov, this.camera.fov * this.camera.aspect) * Math.PI) / 360;
    const distance = (1.15 * radius) / Math.sin(half);
    this.camera.position.copy(center).addScaledVector(towards, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.dispose(); // it reads the camera's up once, when it is made
    this.controls = this.makeControls();
    this.controls.target.copy(center);
    this.controls.minDistance = radius / 5;
    this.controls.maxDistance = radius * 12;
    this.controls.update();
    const sunward = new Vector3(0.3, 1, 0.7).applyQuaternion(upright).normalize();
    this.sun.position.copy(center).addScaledVector(sunward, 5 * radius);
    this.sun.target.position.copy(center);
    const { camera } = this.sun.shadow;
    camera.left = camera.bottom = -1.8 * radius;
    camera.right = camera.top = 1.8 * radius;
    camera.near = radius;
    camera.far = 10 * radius;
    camera.updateProjectionMatrix();
    this.fogAround();
    this.draw();
  }

  private fogAround(): void {
    if (!(this.scene.fog instanceof Fog)) return;
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.scene.fog.near = distance + 2 * this.bounds.radius;
    this.scene.fog.far = distance + 9 * this.bounds.radius;
  }

  private layFloor(): void {
    const { center, radius } = this.bounds;
    this.gridStep = roundUp(radius / 8);
    const lines = 60;
    const size = lines * this.gridStep;
    const points: number[] = [];
    for (let i = 0; i <= lines; ++i) {
      const at = i * this.gridStep - size / 2;
      points.push(at, 0, -size / 2, at, 0, size / 2, -size / 2, 0, at, size / 2, 0, at);
    }
    if (this.grid) {
      this.floor.remove(this.grid);
      this.grid.geometry.dispose();
      this.grid.material.dispose();
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points), 3));
    this.grid = new LineSegments(geometry, new LineBasicMaterial({ color: this.gridColour, transparent: true, opacity: 0.5 }));
    this.grid.raycast = () => undefined;
    this.floor.add(this.grid);
    this.shadow.rotation.x = -Math.PI / 2;
    this.shadow.scale.set(size, size, 1);
    this.floor.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), this.up);
    this.floor.position.copy(center).addScaledVector(this.up, -1.02 * radius);
  }

  /** Draws, if anything has changed since. Returns whether it did. */
  render(): boolean {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return false;
    const wide = Math.floor(width * this.pixelRatio);
    const high = Math.floor(height * this.pixelRatio);
    if (this.canvas.width !== wide || this.canvas.height !== high) {
      this.renderer.setPixelRatio(this.pixelRatio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.wanted = true;
    }
    if (!this.wanted) {
      this.last = 0;
      return false;
    }
    this.wanted = false;
    this.fogAround();
    this.renderer.render(this.scene, this.camera);
    this.pictures += 1;
    this.adapt();
    return true;
  }

  /** Fewer pixels, and then no shadows, where pictures are slow, as without a graphics card. */
  private adapt(): void {
    if (!this.adapts) return;
    const now = performance.now();
    if (this.last > 0) {
      this.taken += now - this.last;
      this.inRow += 1;
    }
    this.last = now;
    if (this.inRow < JUDGED) return;
    const isSlow = this.taken / this.inRow > SLOW;
    this.inRow = 0;
    this.taken = 0;
    if (!isSlow) return;
    if (this.pixelRatio > FEWEST_PIXELS) this.pixelRatio = Math.max(FEWEST_PIXELS, 0.75 * this.pixelRatio);
    else this.sun.castShadow = false;
  }
}
