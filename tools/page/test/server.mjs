// A file server that can be as bad as servers are.

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";

const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".json": "application/json", ".txt": "text/plain" };

/**
 * Serves `folder` on a free port of this machine. `delay`: milliseconds that every answer for a `.neph` file takes longer;
 * `ignoresRanges`: sends everything whatever part is asked for; `bytesPerSecond`: how fast bodies of `.neph` files come.
 */
export async function serveFolder(folder, { delay = 0, ignoresRanges = false, bytesPerSecond = Infinity } = {}) {
  const requests = [];
  const server = createServer(async (request, response) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)).replace(/\/$/, "/index.html");
    const bytes = await readFile(join(folder, name)).catch(() => null);
    if (!bytes) return response.writeHead(404).end();
    const isFile = extname(name) === ".neph";
    if (isFile) {
      requests.push({ method: request.method, range: request.headers.range ?? null });
      await new Promise((resolve) => setTimeout(resolve, delay));
    }
    const head = { "content-type": TYPES[extname(name)] ?? "application/octet-stream" };
    const range = ignoresRanges ? null : /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    const [start, end] = range ? [Number(range[1]), Math.min(Number(range[2]) + 1, bytes.length)] : [0, bytes.length];
    if (start >= bytes.length) return response.writeHead(416, { "content-range": `bytes */${bytes.length}` }).end();
    if (range) head["content-range"] = `bytes ${start}-${end - 1}/${bytes.length}`;
    head["content-length"] = end - start;
    response.writeHead(range ? 206 : 200, head);
    if (request.method === "HEAD") return response.end();
    if (!isFile || bytesPerSecond === Infinity) return response.end(bytes.subarray(start, end));
    const perTick = Math.ceil(bytesPerSecond / 50);
    for (let at = start; at < end && !response.destroyed; at += perTick) {
      response.write(bytes.subarray(at, Math.min(at + perTick, end)));
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    response.end();
  });
  // Tests stand still while the program builds a file; a connection closed meanwhile would fail the next request.
  server.keepAliveTimeout = 120_000;
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    requests,
    close: () => new Promise((resolve) => (server.closeAllConnections(), server.close(resolve))),
  };
}
