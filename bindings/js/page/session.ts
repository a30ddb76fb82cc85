// The worker as the page sees it: one task at a time, which can be cancelled by ending the worker.
// Another worker takes its place then, and with it the memory comes back.
import type { FromWorker, Start, TaskName, Tasks, ToWorker } from "./messages.js";

declare const WORKER_SOURCE: string;

/** Why a task has no answer. */
export class TaskError extends Error {
  constructor(
    readonly code: string,
    message: string,
  ) {
    super(message);
  }
}

export class Session {
  private worker: Worker | null = null;
  private waiting: { resolve: (answer: never) => void; reject: (error: TaskError) => void } | null = null;
  private readonly source = URL.createObjectURL(new Blob([WORKER_SOURCE], { type: "text/javascript" }));

  constructor(
    private readonly module: WebAssembly.Module,
    private readonly onProgress: (stage: string, share: number) => void,
    private readonly onMemory: (bytes: number) => void,
  ) {}

  /** Ends what is going on. restart() has to follow. */
  cancel(): void {
    this.worker?.terminate();
    this.fail("Cancelled", "Cancelled.");
  }

  /** Ends what is going on, and begins with an empty memory. */
  async restart(): Promise<Start> {
    this.cancel();
    const worker = new Worker(this.source);
    this.worker = worker;
    worker.onmessage = (event: MessageEvent<FromWorker>) => {
      if (worker === this.worker) this.handle(event.data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.fail("OutOfMemory", event.message || "The browser has ended the work. Use a smaller scale.");
    };
    return this.run("start", [this.module]);
  }

  run<Name extends TaskName>(
    task: Name,
    given: Parameters<Tasks[Name]>,
    transfer: Transferable[] = [],
  ): Promise<ReturnType<Tasks[Name]>> {
    if (this.waiting) throw new Error("There is work already.");
    return new Promise((resolve, reject) => {
      this.waiting = { resolve, reject };
      this.worker!.postMessage({ task, given } satisfies ToWorker, transfer);
    });
  }

  private fail(code: string, message: string): void {
    const waiting = this.waiting;
    this.waiting = null;
    waiting?.reject(new TaskError(code, message));
  }

  private handle(message: FromWorker): void {
    switch (message.kind) {
      case "progress":
        return this.onProgress(message.stage, message.share);
      case "failed":
        return this.fail(message.code, message.message);
      case "done": {
        const waiting = this.waiting;
        this.waiting = null;
        this.onMemory(message.memory);
        waiting?.resolve(message.answer as never);
      }
    }
  }
}
