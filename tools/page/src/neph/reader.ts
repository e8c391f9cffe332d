// A file behind an address, read in ranges (RFC 9110, section 14).
//
// Every answer is held against the first: length and tag must stay, else the file is another one by now. A server that ignores
// ranges sends everything from the beginning; then that one answer serves all reads as it comes in.

import { changed, cutShort, unreachable } from "./failure.ts";

/** What tells one version of a file from another. */
interface Identity {
  bytes: number | null;
  tag: string | null;
  modified: string | null;
}

export class Reader {
  /** Bytes that have come over the network. */
  bytesRead = 0;
  /** Requests for parts of the file. */
  requests = 0;
  /** Length of the file, known once anything was read. */
  length: number | null = null;
  private identity: Identity | null = null;
  private whole: Whole | null = null;

  constructor(readonly url: string) {}

  /** True once a server has sent everything where a part was asked for. */
  get ignoresRanges(): boolean {
    return this.whole !== null;
  }

  /**
   * Bytes `start..end` of the file; fewer only where the file ends before `end` and `mayEnd` is set.
   *
   * Throws a `Failure` if the file is shorter, has changed or cannot be read.
   */
  async read(start: number, end: number, mayEnd = false): Promise<Uint8Array<ArrayBuffer>> {
    if (this.whole) return this.whole.read(start, end, mayEnd);
    this.requests++;
    const response = await fetch(this.url, { headers: { Range: `bytes=${start}-${end - 1}` }, cache: "no-store" }).catch(
      (error: Error) => {
        throw unreachable(`No answer from the server (${error.message})`);
      },
    );
    if (response.status === 416) {
      const total = Number(/\*\/(\d+)/.exec(response.headers.get("content-range") ?? "")?.[1] ?? 0);
      await response.body?.cancel();
      if (this.length !== null && this.length !== total) throw changed();
      if (mayEnd && start >= total) return new Uint8Array(0);
      throw cutShort(total, end);
    }
    if (response.status === 200) {
      this.recognise(response, Number(response.headers.get("content-length")) || null);
      // Others may have been under way when the first such answer came.
      if (this.whole) await response.body?.cancel();
      else this.whole = new Whole(response, (bytes) => (this.bytesRead += bytes));
      return (this.whole as Whole).read(start, end, mayEnd);
    }
    if (response.status !== 206) {
      await response.body?.cancel();
      throw unreachable(`The server answered ${response.status} ${response.statusText}`.trim());
    }
    const range = /^bytes (\d+)-(\d+)\/(\d+|\*)$/.exec(response.headers.get("content-range") ?? "");
    this.recognise(response, range && range[3] !== "*" ? Number(range[3]) : null);
    return this.part(response, start, end, mayEnd);
  }

  /** Throws if the file is another one by now; asks for nothing but its head. Servers that do not answer are no news. */
  async look(): Promise<void> {
    const response = await fetch(this.url, { method: "HEAD", cache: "no-store" }).catch(() => null);
    if (response?.ok) this.recognise(response, Number(response.headers.get("content-length")) || null);
  }

  private async part(response: Response, start: number, end: number, mayEnd: boolean): Promise<Uint8Array<ArrayBuffer>> {
    const bytes = new Uint8Array(
      await response.arrayBuffer().catch(() => {
        throw unreachable("The server stopped in the middle of an answer");
      }),
    );
    this.bytesRead += bytes.length;
    const expected = this.length === null ? end - start : Math.min(end, this.length) - start;
    if (bytes.length > end - start) throw unreachable("The server sent more than it was asked for");
    if (bytes.length < expected || (bytes.length < end - start && !mayEnd)) throw cutShort(start + bytes.length, end);
    return bytes;
  }

  private recognise(response: Response, bytes: number | null): void {
    const { headers } = response;
    const found = { bytes, tag: headers.get("etag"), modified: headers.get("last-modified") };
    const known = this.identity;
    if (known) {
      const differs = (a: unknown, b: unknown) => a !== null && b !== null && a !== b;
      if (differs(known.bytes, found.bytes) || differs(known.tag, found.tag) || differs(known.modified, found.modified)) {
        throw changed();
      }
    }
    this.identity = known ?? found;
    this.length ??= bytes;
  }
}

/** An answer with the whole file, read from its beginning on; reads wait until their bytes are there. */
class Whole {
  private bytes: Uint8Array<ArrayBuffer>;
  private arrived = 0;
  private hasEnded = false;
  private failure: Error | null = null;
  private waiting: (() => void)[] = [];

  constructor(response: Response, count: (bytes: number) => void) {
    this.bytes = new Uint8Array(Number(response.headers.get("content-length")) || 1 << 20);
    this.receive(response, count).catch((error: Error) => {
      this.failure = unreachable(`The server stopped in the middle of an answer (${error.message})`);
      this.wake();
    });
  }

  async read(start: number, end: number, mayEnd: boolean): Promise<Uint8Array<ArrayBuffer>> {
    while (this.arrived < end && !this.hasEnded && !this.failure) {
      await new Promise<void>((resolve) => this.waiting.push(resolve));
    }
    if (this.arrived < end && this.failure) throw this.failure;
    if (this.arrived < end && !mayEnd) throw cutShort(this.arrived, end);
    return this.bytes.slice(start, Math.min(end, this.arrived));
  }

  private async receive(response: Response, count: (bytes: number) => void): Promise<void> {
    const reader = response.body!.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      if (this.arrived + value.length > this.bytes.length) {
        const larger = new Uint8Array(Math.max(2 * this.bytes.length, this.arrived + value.length));
        larger.set(this.bytes.subarray(0, this.arrived));
        this.bytes = larger;
      }
      this.bytes.set(value, this.arrived);
      this.arrived += value.length;
      count(value.length);
      this.wake();
    }
    this.hasEnded = true;
    this.wake();
  }

  private wake(): void {
    const waiting = this.waiting;
    this.waiting = [];
    for (const resolve of waiting) resolve();
  }
}
