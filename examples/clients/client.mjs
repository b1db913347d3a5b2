// A client of `motionrt serve` for Node and for web pages; nothing to install.
//
//   motionrt serve --gallery my_library      # prints the token
//   MOTIONRT_TOKEN=... node client.mjs "a person walks and turns left"
//
// A web page needs `motionrt serve --origin https://its.address`. Node before 22: node --experimental-websocket.

export class Client {
  constructor(url, token) {
    Object.assign(this, { url: url.replace(/\/$/, ""), token });
  }

  /** A Response; an Error with the service's words where it refuses. */
  async ask(path, body) {
    const headers = { Authorization: `Bearer ${this.token}`, "Content-Type": "application/json" };
    const answer = await fetch(this.url + path, { method: body ? "POST" : "GET", headers, body: body && JSON.stringify(body) });
    if (!answer.ok) throw new Error((await answer.json()).error.message);
    return answer;
  }

  /** [{ clip, start_s, end_s, score, ... }], best first. */
  async retrieve(text, options = {}) {
    return (await (await this.ask("/v1/retrieve", { text, ...options })).json()).hits;
  }

  /** The motion of a hit as the bytes of a file. */
  async motion({ clip, start_s, end_s }, format = "glb") {
    const query = new URLSearchParams({ clip, start_s, end_s, format });
    return new Uint8Array(await (await this.ask(`/v1/motion?${query}`)).arrayBuffer());
  }

  /** A motion of a text as the bytes of a file. */
  async generate(text, options = {}) {
    return new Uint8Array(await (await this.ask("/v1/generate", { text, ...options })).arrayBuffer());
  }

  /** Walk to { x, z, heading }: frames { frame, root, rotations } at 30 fps; return `true` from `seen` to end it. */
  walk(goal, seen) {
    return new Promise((resolve, reject) => {
      const socket = new WebSocket(`${this.url.replace(/^http/, "ws")}/v1/walk?token=${encodeURIComponent(this.token)}`);
      socket.onopen = () => socket.send(JSON.stringify(goal));
      socket.onmessage = ({ data }) => {
        const told = JSON.parse(data);
        if ("frame" in told && seen(told, (next) => socket.send(JSON.stringify(next)))) socket.close();
      };
      socket.onclose = ({ code, reason }) => (code < 4000 ? resolve() : reject(new Error(reason)));
    });
  }
}

if (typeof process !== "undefined" && process.argv[1] === new URL(import.meta.url).pathname) {
  const client = new Client(process.env.MOTIONRT_URL ?? "http://127.0.0.1:8321", process.env.MOTIONRT_TOKEN);
  const hits = await client.retrieve(process.argv[2] ?? "a person walks in a circle", { k: 3 });
  for (const hit of hits) console.log(hit.score.toFixed(3), hit.clip, hit.start_s, hit.end_s);
  if (hits.length) console.log("the best one:", (await client.motion(hits[0])).length, "bytes of .glb");
  await client.walk({ x: 0, z: 3 }, ({ frame, root }) => {
    if (frame % 10 === 0) console.log(`frame ${frame}: pelvis at ${root}`);
    return frame === 30;
  });
}
