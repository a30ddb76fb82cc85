// Pictures that are saved: how large they shall be, and the file.
import { element } from "./dom";

export interface WantedPicture {
  width: number;
  height: number;
  transparent: boolean;
  legend: boolean;
}

/** What the panel asks for; null if those are no sizes, of which the browser then tells. */
export function askedPicture(canvas: HTMLElement): WantedPicture | null {
  const inputs = ["picture-width", "picture-height"].map((id) => element<HTMLInputElement>(id));
  if (!inputs.every((input) => input.reportValidity())) return null;
  const { clientWidth, clientHeight } = canvas;
  const [width, height] = inputs.map((input) => input.valueAsNumber) as [number, number];
  const ratio = Math.min(window.devicePixelRatio, 2);
  // What is not given follows from the shape of the canvas.
  const scale = width / clientWidth || height / clientHeight || ratio;
  const checked = (id: string) => element<HTMLInputElement>(id).checked;
  return {
    width: width || Math.max(1, Math.round(clientWidth * scale)),
    height: height || Math.max(1, Math.round(clientHeight * scale)),
    transparent: checked("picture-transparent"),
    legend: checked("picture-legend"),
  };
}

export async function savePng(picture: HTMLCanvasElement, name: string): Promise<void> {
  const blob = await new Promise<Blob | null>((resolve) => picture.toBlob(resolve));
  if (!blob) throw new Error("The browser could not make a picture.");
  saveFile(blob, name);
}

export function saveFile(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
