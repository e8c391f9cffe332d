// The page's side of its worker.

import type { Job, Result } from "./work.ts";

interface Waiting {
  resolve: (result: never) => void;
  reject: (error: Error) => void;
}

export class Hand {
  private readonly worker = new Worker(new URL("worker.js", document.baseURI), { type: "module" });
  private readonly waiting = new Map<number, Waiting>();
  private nextId = 1;

  constructor() {
    this.worker.onmessage = ({ data }) => {
      const { resolve, reject } = this.waiting.get(data.id) as Waiting;
      this.waiting.delete(data.id);
      if (data.error === undefined) resolve(data.result as never);
      else reject(new Error(data.error));
    };
    this.worker.onerror = (event) => {
      for (const { reject } of this.waiting.values()) reject(new Error(event.message || "the worker could not be started"));
      this.waiting.clear();
    };
  }

  /** Does a job; `transfer` lists buffers that the page gives away. */
  do<J extends Job>(job: J, transfer: ArrayBuffer[]): Promise<Result<J>> {
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (result: never) => void, reject });
      this.worker.postMessage({ id, job }, transfer);
    });
  }

  stop(): void {
    this.worker.terminate();
  }
}
