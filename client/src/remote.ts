/** A file beside the page: by ranges from servers that have them, else in order from its beginning. */

import type { Parts } from "./archive";

const TRIES = 3;

interface Waiting {
  end: number;
  resolve: () => void;
}

export class Remote implements Parts {
  readonly bytes: Uint8Array;
  private come = 0;                          // bytes from the beginning, of a server without ranges
  private whole: Promise<void> | null = null;
  private waiting: Waiting[] = [];
  private had: [number, number][] = [];      // ranges that have come

  constructor(private file: string, size: number) {
    this.bytes = new Uint8Array(size);
  }

  /** Have the bytes from `begin` to `end`. */
  async need(begin: number, end: number): Promise<void> {
    if (end <= begin || this.had.some(([from, to]) => from <= begin && to >= end)) return;
    if (!this.whole) await this.tried(begin, end);
    if (this.whole) await this.upTo(end);
  }

  private async tried(begin: number, end: number): Promise<void> {
    for (let left = TRIES - 1; ; --left) {
      try {
        return await this.ask(begin, end);
      } catch (error) {
        if (!(error instanceof TypeError)) throw error; // a connection that breaks is a TypeError
        if (!left)
          throw new Error(
            `${this.file} cannot be read: the connection to its server broke, or there is no server. ` +
              'Files beside a page need one; "python -m http.server" is enough.',
          );
        await new Promise((resolve) => setTimeout(resolve, 500));
      }
    }
  }

  private async ask(begin: number, end: number): Promise<void> {
    const answer = await fetch(this.file, { headers: { Range: `bytes=${begin}-${end - 1}` } });
    if (!answer.ok) throw new Error(`${this.file} cannot be read (${answer.status}); it must lie beside this page.`);
    if (answer.status !== 206) {
      if (this.whole) void answer.body?.cancel();
      else this.whole = this.flow(answer);
      return;
    }
    const size = Number(/\/(\d+)$/.exec(answer.headers.get("Content-Range") ?? "")?.[1] ?? this.bytes.length),
      part = new Uint8Array(await answer.arrayBuffer());
    if (size !== this.bytes.length || part.length !== end - begin) throw this.changed(size);
    this.bytes.set(part, begin);
    this.had.push([begin, end]);
  }

  /** Take all in as it comes. */
  private async flow(answer: Response): Promise<void> {
    const reader = answer.body!.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      if (this.come + value.length > this.bytes.length) throw this.changed(this.come + value.length);
      this.bytes.set(value, this.come);
      this.come += value.length;
      this.waiting = this.waiting.filter((one) => (one.end <= this.come ? one.resolve() : true));
    }
    if (this.come !== this.bytes.length) throw this.changed(this.come);
  }

  private async upTo(end: number): Promise<void> {
    if (end > this.come) await Promise.race([this.whole, new Promise<void>((resolve) => this.waiting.push({ end, resolve }))]);
  }

  private changed(size: number): Error {
    return new Error(
      `${this.file} has ${size} bytes, and this page was made with one of ${this.bytes.length}. Copy the page and its folder again.`,
    );
  }
}
