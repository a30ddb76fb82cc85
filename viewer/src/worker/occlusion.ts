// How much of the sky each corner of a drawn face sees: depth maps of the drawn faces, seen from many
// sides. Computed here and not by the graphics card, so that it costs nothing while one turns the
// mesh, and comes out the same on every machine.

/** Texels along a side of a depth map; the scene is within a ball of radius sqrt(3) / 2. */
const kSide = 192;
const kScale = kSide / Math.sqrt(3.1);
/** Corners are lifted off their faces, or faces would shade themselves. */
const kLift = 1.2 / kScale;
/** Share of the way from a corner to the middle of its face: neighbours of a crease differ. */
const kInset = 0.15;

const kMostDirections = 64;
const kFewestDirections = 24;
/** Faces times directions: a few tenths of a second. */
const kMostWork = 4e6;

/** All of the sky, and a guess where nothing is known. */
const kOpen = 255;
const kUnknown = 200;

/** Spread evenly over the sphere, and so is every first part of them (Roberts' sequence R2). */
function direction(i: number): [number, number, number] {
  const z = 1 - 2 * ((0.5 + 0.7548776662466927 * i) % 1);
  const radius = Math.sqrt(1 - z * z);
  const angle = 2 * Math.PI * ((0.5698402909980532 * i) % 1);
  return [radius * Math.cos(angle), radius * Math.sin(angle), z];
}

/** Two axes across a direction. */
function across([x, y, z]: [number, number, number]): [number[], number[]] {
  const flat = Math.hypot(x, y);
  const right = flat > 1e-6 ? [-y / flat, x / flat, 0] : [1, 0, 0];
  const up = [
    y * right[2]! - z * right[1]!, z * right[0]! - x * right[2]!, x * right[1]! - y * right[0]!,
  ];
  return [right, up];
}

export class Occlusion {
  /** Four numbers per quad, one for each corner: 0 for no sky, 255 for all of what it could see. */
  readonly shares: Uint8Array<ArrayBuffer>;
  private readonly count: number;
  private readonly directions: number;
  private done = 0;
  /** Corners of the quads, and the same places lifted and inset, three numbers each. */
  private readonly corners: Float32Array;
  private readonly places: Float32Array;
  private readonly normals: Float32Array;
  private readonly seen: Float32Array;
  private readonly whole: Float32Array;
  private readonly depths = new Float32Array(kSide * kSide);

  constructor(readonly quads: Uint32Array<ArrayBuffer>, positions: Float32Array) {
    this.count = quads.length / 6;
    this.directions = Math.round(Math.min(kMostDirections,
      Math.max(kFewestDirections, kMostWork / Math.max(this.count, 1))));
    this.shares = new Uint8Array(4 * this.count).fill(kOpen);
    this.corners = new Float32Array(12 * this.count);
    this.places = new Float32Array(12 * this.count);
    this.normals = new Float32Array(3 * this.count);
    this.seen = new Float32Array(4 * this.count);
    this.whole = new Float32Array(this.count);
    for (let quad = 0; quad < this.count; ++quad) this.place(quad, positions);
  }

  private place(quad: number, positions: Float32Array): void {
    const { quads, corners, places, normals } = this;
    for (let k = 0; k < 4; ++k) {
      for (let axis = 0; axis < 3; ++axis) {
        corners[12 * quad + 3 * k + axis] = positions[4 * quads[6 * quad + k]! + axis]!;
      }
    }
    const at = (k: number, axis: number) => corners[12 * quad + 3 * k + axis]!;
    const [ax, ay, az] = [0, 1, 2].map((axis) => at(2, axis) - at(0, axis)) as [number, number, number];
    const [bx, by, bz] = [0, 1, 2].map((axis) => at(3, axis) - at(1, axis)) as [number, number, number];
    const normal = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    const length = Math.hypot(...normal) || 1;
    for (let axis = 0; axis < 3; ++axis) {
      const n = normal[axis]! / length;
      normals[3 * quad + axis] = n;
      const middle = (at(0, axis) + at(1, axis) + at(2, axis) + at(3, axis)) / 4;
      for (let k = 0; k < 4; ++k) {
        places[12 * quad + 3 * k + axis] = at(k, axis) + kInset * (middle - at(k, axis)) + kLift * n;
      }
    }
  }

  get finished(): boolean {
    return this.done >= this.directions;
  }

  /** Looks from as many directions as fit into a time. */
  work(milliseconds: number): void {
    const end = performance.now() + milliseconds;
    while (!this.finished && performance.now() < end) this.look(direction(this.done++));
    if (this.finished) this.sum();
  }

  private look(towards: [number, number, number]): void {
    const [right, up] = across(towards);
    this.depths.fill(-Infinity);
    const screen = new Float32Array(12);
    for (let quad = 0; quad < this.count; ++quad) {
      if (this.facing(quad, towards) <= 0) continue;
      for (let k = 0; k < 4; ++k) this.project(this.corners, 12 * quad + 3 * k, right, up, towards, screen, 3 * k);
      this.fill(screen, 0, 3, 6);
      this.fill(screen, 0, 6, 9);
    }
    for (let quad = 0; quad < this.count; ++quad) {
      const facing = this.facing(quad, towards);
      if (facing <= 0) continue;
      this.whole[quad]! += facing;
      for (let k = 0; k < 4; ++k) {
        this.project(this.places, 12 * quad + 3 * k, right, up, towards, screen, 0);
        this.seen[4 * quad + k]! += facing * this.openAt(screen[0]!, screen[1]!, screen[2]!);
      }
    }
  }

  private facing(quad: number, towards: number[]): number {
    const { normals } = this;
    return normals[3 * quad]! * towards[0]! + normals[3 * quad + 1]! * towards[1]! +
      normals[3 * quad + 2]! * towards[2]!;
  }

  private project(from: Float32Array, at: number, right: number[], up: number[], towards: number[],
                  to: Float32Array, place: number): void {
    const x = from[at]!;
    const y = from[at + 1]!;
    const z = from[at + 2]!;
    to[place] = (right[0]! * x + right[1]! * y) * kScale + kSide / 2;
    to[place + 1] = (up[0]! * x + up[1]! * y + up[2]! * z) * kScale + kSide / 2;
    to[place + 2] = towards[0]! * x + towards[1]! * y + towards[2]! * z;
  }

  /** Draws a triangle into the depth map. */
  private fill(screen: Float32Array, a: number, b: number, c: number): void {
    const { depths } = this;
    const ax = screen[a]!, ay = screen[a + 1]!, az = screen[a + 2]!;
    const bx = screen[b]! - ax, by = screen[b + 1]! - ay, bz = screen[b + 2]! - az;
    const cx = screen[c]! - ax, cy = screen[c + 1]! - ay, cz = screen[c + 2]! - az;
    const area = bx * cy - by * cx;
    if (Math.abs(area) < 1e-9) return;
    const left = Math.max(0, Math.ceil(ax + Math.min(0, bx, cx) - 0.5));
    const last = Math.min(kSide - 1, Math.floor(ax + Math.max(0, bx, cx) - 0.5));
    const bottom = Math.max(0, Math.ceil(ay + Math.min(0, by, cy) - 0.5));
    const top = Math.min(kSide - 1, Math.floor(ay + Math.max(0, by, cy) - 0.5));
    for (let row = bottom; row <= top; ++row) {
      for (let column = left; column <= last; ++column) {
        const x = column + 0.5 - ax;
        const y = row + 0.5 - ay;
        const s = (x * cy - y * cx) / area;
        const t = (bx * y - by * x) / area;
        if (s < -1e-4 || t < -1e-4 || s + t > 1.0001) continue;
        const depth = az + s * bz + t * cz;
        if (depth > depths[row * kSide + column]!) depths[row * kSide + column] = depth;
      }
    }
  }

  /** Whether nothing is in front, between the four texels around. */
  private openAt(x: number, y: number, depth: number): number {
    const column = Math.floor(x - 0.5);
    const row = Math.floor(y - 0.5);
    if (column < 0 || row < 0 || column >= kSide - 1 || row >= kSide - 1) return 1;
    const s = x - 0.5 - column;
    const t = y - 0.5 - row;
    const at = row * kSide + column;
    const { depths } = this;
    return (depths[at]! <= depth ? (1 - s) * (1 - t) : 0) +
      (depths[at + 1]! <= depth ? s * (1 - t) : 0) +
      (depths[at + kSide]! <= depth ? (1 - s) * t : 0) +
      (depths[at + kSide + 1]! <= depth ? s * t : 0);
  }

  private sum(): void {
    for (let i = 0; i < this.shares.length; ++i) {
      const whole = this.whole[i >> 2]!;
      this.shares[i] = whole > 0 ? Math.round((kOpen * this.seen[i]!) / whole) : kOpen;
    }
  }
}

/** The light of an earlier picture on the quads of the next: both are sorted by cell and face. */
export function carriedLight(quads: Uint32Array, light: Uint8Array, next: Uint32Array): Uint8Array<ArrayBuffer> {
  const carried = new Uint8Array((4 * next.length) / 6).fill(kUnknown);
  let from = 0;
  for (let to = 0; to < next.length; to += 6) {
    while (from < quads.length && quads[from + 4]! < next[to + 4]!) from += 6;
    for (let same = from; same < quads.length && quads[same + 4] === next[to + 4]; same += 6) {
      if (quads[same] !== next[to] || quads[same + 2] !== next[to + 2]) continue;
      carried.set(light.subarray((4 * same) / 6, (4 * same) / 6 + 4), (4 * to) / 6);
    }
  }
  return carried;
}
