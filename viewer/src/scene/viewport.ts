// The canvas: camera, drawing on demand, picking, pictures.
import {
  Color,
  LinearSRGBColorSpace,
  LineSegments,
  type Material,
  Mesh,
  type Object3D,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Surface } from "./surface";

export interface CameraState {
  position: [number, number, number];
  target: [number, number, number];
}

const kFieldOfView = 30;
/** Where one looks from at first. */
const kHome: Triple = [1, -1.6, 0.9];
/** Share of the canvas that the mesh fills at first. */
const kFilled = 0.9;
/** The same for a ball that one goes close to. */
const kApproached = 0.4;

type Triple = [number, number, number];

export class Viewport {
  readonly scene = new Scene();
  private readonly pickScene = new Scene();
  private readonly camera = new PerspectiveCamera(kFieldOfView, 1, 0.001, 100);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly pickTarget = new WebGLRenderTarget(1, 1);
  private frame = 0;
  private surface: Surface | null = null;

  /**
   * @param half  half the sides of the box around what is drawn
   * @param outline  points, four numbers each, that are in the picture at first
   * @throws if the browser has no WebGL 2
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly half: Triple,
    private readonly outline: Float32Array,
    onMoved: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    // Colours are written as they are: those of the legend are those on the screen.
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.005;
    this.controls.maxDistance = 20;
    this.resize();  // first: how far away is far enough depends on the canvas' shape
    this.look();
    this.controls.addEventListener("change", () => this.redraw());
    this.controls.addEventListener("end", onMoved);
    new ResizeObserver(() => this.reshape()).observe(canvas);
  }

  add(object: Object3D): void {
    this.scene.add(object);
  }

  /** Takes an object away for good. */
  remove(object: Object3D): void {
    this.scene.remove(object);
    object.traverse((part) => {
      if (!(part instanceof Mesh || part instanceof LineSegments)) return;
      part.geometry.dispose();
      (part.material as Material).dispose();
    });
  }

  setSurface(surface: Surface): void {
    this.surface = surface;
    surface.setPixelRatio(this.renderer.getPixelRatio());
    this.scene.add(surface.mesh, surface.ghost);
    this.pickScene.add(surface.pickMesh);
  }

  setBackground(colour: string): void {
    this.scene.background = new Color().setStyle(colour, LinearSRGBColorSpace);
    this.redraw();
  }

  /** Looks at the whole mesh from a direction. */
  look(from: [number, number, number] = kHome): void {
    // A camera straight above would not know which way is up.
    const direction = new Vector3(...from).normalize();
    if (Math.abs(direction.z) > 0.999) direction.y -= 1e-4;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(direction.multiplyScalar(this.distanceAlong(direction)));
    this.controls.update();
    this.redraw();
  }

  /** From where on a direction all of the outline is in the picture. */
  private distanceAlong(direction: Vector3): number {
    const right = new Vector3(0, 0, 1).cross(direction).normalize();
    const up = direction.clone().cross(right);
    const tall = Math.tan((kFieldOfView / 2) * (Math.PI / 180)) * kFilled;
    const wide = tall * this.camera.aspect;
    let distance = 0;
    const place = new Vector3();
    for (let at = 0; at < this.outline.length; at += 4) {
      place.fromArray(this.outline, at);
      const across = Math.max(Math.abs(place.dot(right)) / wide, Math.abs(place.dot(up)) / tall);
      distance = Math.max(distance, across + place.dot(direction));
    }
    return distance;
  }

  /** Goes close to a ball without changing the direction of view. */
  approach(place: Triple, radius: number): void {
    const distance = radius / (kApproached * Math.tan((kFieldOfView / 2) * (Math.PI / 180)));
    const direction = new Vector3(...this.viewDirection());
    this.controls.target.set(...place);
    this.camera.position.copy(this.controls.target).addScaledVector(direction, distance);
    this.controls.update();
    this.redraw();
  }

  /** From the scene towards the camera, of length 1. */
  viewDirection(): [number, number, number] {
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    return [direction.x, direction.y, direction.z];
  }

  get cameraState(): CameraState {
    const { position } = this.camera;
    const { target } = this.controls;
    return { position: [position.x, position.y, position.z], target: [target.x, target.y, target.z] };
  }

  set cameraState(state: CameraState) {
    this.camera.position.set(...state.position);
    this.controls.target.set(...state.target);
    this.controls.update();
    this.redraw();
  }

  /** Draws before the next frame; several calls draw once. */
  redraw(): void {
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  /** The cell under a point of the canvas in CSS pixels, or null. */
  pick(x: number, y: number): number | null {
    if (!this.surface?.pickMesh.visible) return null;
    const { clientWidth, clientHeight } = this.canvas;
    this.fitDepth();
    this.camera.setViewOffset(clientWidth, clientHeight, x, y, 1, 1);
    this.renderer.setRenderTarget(this.pickTarget);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear();
    this.renderer.render(this.pickScene, this.camera);
    const bytes = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.pickTarget, 0, 0, 1, 1, bytes);
    this.renderer.setRenderTarget(null);
    this.camera.clearViewOffset();
    const id = bytes[0]! + 256 * (bytes[1]! + 256 * (bytes[2]! + 256 * bytes[3]!));
    return id === 0 ? null : id - 1;
  }

  /**
   * What is on the canvas, in pixels of a size; where its shape is another one, more is to be seen.
   * @throws if the browser does not draw pictures of that size
   */
  picture(width: number, height: number, transparent: boolean): HTMLCanvasElement {
    const { background } = this.scene;
    const { aspect } = this.camera;
    if (transparent) this.scene.background = null;
    const narrower = Math.max(1, (aspect * height) / width);
    this.camera.fov = (360 / Math.PI) * Math.atan(narrower * Math.tan((kFieldOfView * Math.PI) / 360));
    try {
      this.setSize(width, height, Math.min(width / this.canvas.clientWidth, height / this.canvas.clientHeight));
      const { drawingBufferWidth, drawingBufferHeight } = this.renderer.getContext();
      if (drawingBufferWidth !== width || drawingBufferHeight !== height) {
        throw new Error(`This browser draws no pictures of ${width} by ${height} pixels: take fewer.`);
      }
      this.draw();
      const copy = document.createElement("canvas");
      copy.width = width;
      copy.height = height;
      copy.getContext("2d")!.drawImage(this.canvas, 0, 0);
      return copy;
    } finally {
      this.scene.background = background;
      this.camera.fov = kFieldOfView;
      this.resize();
      this.draw();
    }
  }

  private draw(): void {
    this.fitDepth();
    this.renderer.render(this.scene, this.camera);
  }

  /** Depth from before to behind the scene and no further, so that near things are told apart. */
  private fitDepth(): void {
    const distance = this.camera.position.length();
    const radius = 1.05 * Math.hypot(...this.half);
    const closest = 0.02 * this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance - radius, closest);
    this.camera.far = Math.max(distance + radius, 2 * this.camera.near);
    this.camera.updateProjectionMatrix();
  }

  /** The canvas has another shape: as much of the mesh is in the picture as before. */
  private reshape(): void {
    const direction = new Vector3(...this.viewDirection());
    const before = this.distanceAlong(direction);
    this.resize();
    const offset = this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(offset, this.distanceAlong(direction) / before);
    this.controls.update();
    this.redraw();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    // More pixels than two per CSS pixel cost time and show nothing.
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.setSize(Math.floor(clientWidth * ratio), Math.floor(clientHeight * ratio), ratio);
    this.redraw();
  }

  /** @param ratio  pixels of the picture per pixel of the page */
  private setSize(width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(ratio);
    // Halves, so that products that are rounded down are the numbers that are meant.
    this.renderer.setSize((width + 0.5) / ratio, (height + 0.5) / ratio, false);
    this.surface?.setPixelRatio(ratio);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
}
