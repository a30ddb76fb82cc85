// A mesh before and after it was improved: the same cells, with other positions and values.

/** What differs between both. */
export interface Moment {
  /** Four numbers per vertex or node, of which the first three are its position. */
  positions: Float32Array<ArrayBuffer>;
  /** Scaled Jacobians, as stored. */
  quality: Uint16Array<ArrayBuffer>;
  /** Cells that are not certified. */
  notPositive: Uint32Array<ArrayBuffer>;
}

/** The moment that is shown. Without an earlier one, it is what the page holds. */
export class Moments {
  /** Those that are shown: always the same array. */
  readonly positions: Float32Array<ArrayBuffer>;
  private shown = 1;

  constructor(private readonly after: Moment, private readonly before: Moment | null) {
    this.positions = before ? after.positions.slice() : after.positions;
  }

  get quality(): Uint16Array<ArrayBuffer> {
    return this.nearest.quality;
  }

  get notPositive(): Uint32Array<ArrayBuffer> {
    return this.nearest.notPositive;
  }

  /** In between, values are those of the end that is nearer: what a cell is worth on its way, nobody has asked. */
  private get nearest(): Moment {
    return this.before && isBefore(this.shown) ? this.before : this.after;
  }

  /** @param share  of the way from before (0) to after (1)  @return whether it is another one */
  show(share: number): boolean {
    if (!this.before || share === this.shown) return false;
    this.shown = share;
    const [from, to] = [this.before.positions, this.after.positions];
    for (let i = 0; i < to.length; ++i) {
      // The very numbers at both ends.
      this.positions[i] = share === 1 ? to[i]! : from[i]! + share * (to[i]! - from[i]!);
    }
    return true;
  }
}

/** Whether a place on the way counts as before. */
export function isBefore(share: number): boolean {
  return share < 0.5;
}
