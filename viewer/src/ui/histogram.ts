// The histogram of the scaled Jacobian, which filters when it is brushed.
import { cssOf, kBadColour, insideQuality } from "../colours";
import { kHistogramBins } from "../worker/visible";

/** Values of the shown range and of what is kept in it. */
export class Histogram {
  private candidates = new Uint32Array(kHistogramBins);
  private kept = new Uint32Array(kHistogramBins);
  private range: [number, number] = [-1, 1];
  private brushFrom: number | null = null;
  private readonly firstBin: number;

  /** @param lowest  smallest value of the mesh: the axis begins at the bin that has it */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    lowest: number,
    private readonly onBrush: (range: [number, number]) => void,
  ) {
    this.firstBin = Math.min(kHistogramBins - 8, Math.floor(((lowest + 1) / 2) * kHistogramBins));
    if (lowest > 0) this.firstBin = Math.max(this.firstBin - 1, kHistogramBins / 2);
    this.firstBin = Math.max(0, this.firstBin);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.brushFrom = this.valueAt(event);
    });
    canvas.addEventListener("pointermove", (event) => this.brush(event));
    canvas.addEventListener("pointerup", (event) => {
      this.brush(event);
      this.brushFrom = null;
    });
    canvas.addEventListener("dblclick", () => this.onBrush([-1, 1]));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  set(candidates: Uint32Array<ArrayBuffer>, kept: Uint32Array<ArrayBuffer>): void {
    this.candidates = candidates;
    this.kept = kept;
    this.draw();
  }

  setRange(range: [number, number]): void {
    this.range = range;
    this.draw();
  }

  private get lowest(): number {
    return (this.firstBin / kHistogramBins) * 2 - 1;
  }

  private valueAt(event: PointerEvent): number {
    const share = event.offsetX / Math.max(1, this.canvas.clientWidth);
    return this.lowest + Math.min(Math.max(share, 0), 1) * (1 - this.lowest);
  }

  private brush(event: PointerEvent): void {
    if (this.brushFrom === null) return;
    const to = this.valueAt(event);
    const range = [Math.min(this.brushFrom, to), Math.max(this.brushFrom, to)];
    if (range[1]! - range[0]! < 0.005) return;  // a click is no brush
    // The left end of the axis is the smallest value there is.
    if (range[0]! <= this.lowest) range[0] = -1;
    this.onBrush([range[0]!, range[1]!]);
  }

  draw(): void {
    const ratio = Math.min(window.devicePixelRatio, 2);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const context = this.canvas.getContext("2d")!;
    const style = getComputedStyle(this.canvas);
    context.scale(ratio, ratio);
    context.clearRect(0, 0, width, height);
    const bins = kHistogramBins - this.firstBin;
    const base = height - 14;
    const most = Math.max(1, ...this.candidates);
    for (let i = 0; i < bins; ++i) {
      const bin = this.firstBin + i;
      const centre = ((bin + 0.5) / kHistogramBins) * 2 - 1;
      const bar = (count: number, colour: string) => {
        if (count === 0) return;
        const tall = Math.max(1.5, (count / most) * (base - 2));
        context.fillStyle = colour;
        context.fillRect((i * width) / bins + 0.5, base - tall, width / bins - 1, tall);
      };
      bar(this.candidates[bin]!, style.getPropertyValue("--line"));
      const colour = centre <= 0 ? cssOf(kBadColour) : `rgb(${insideQuality(centre).join()})`;
      bar(this.kept[bin]!, colour);
    }
    const x = (value: number) => ((value - this.lowest) / (1 - this.lowest)) * width;
    context.fillStyle = style.getPropertyValue("--text");
    for (const value of this.range) {
      if (value > this.lowest && value < 1) context.fillRect(x(value) - 1, 0, 2, base);
    }
    context.font = "11px system-ui, sans-serif";
    context.fillText(this.lowest.toFixed(2), 0, height - 3);
    context.textAlign = "right";
    context.fillText("1", width, height - 3);
  }
}
