// Loads the laboratory, and tells how far that is.

const before = document.getElementById("before");
const bar = document.getElementById("bar");
const said = document.getElementById("said");
const again = document.getElementById("again");

function say(text) {
    said.textContent = text;
}

/** Says why there is no laboratory, in its place. */
function refuse(text) {
    bar.hidden = true;
    before.hidden = false;
    say(text);
}

/** Says over the picture why there is no further one. */
function stop(text) {
    const first = again.hidden;
    before.classList.add("over");
    refuse(text);
    again.hidden = false;
    // Keys that were meant for the laboratory do not press it.
    if (first) said.focus();
}

again.addEventListener("click", () => location.reload());
addEventListener("lab-shown", () => {
    before.hidden = true;
    document.getElementById("lab").focus();
});
addEventListener("lab-told", (event) => {
    if (!before.hidden) say(event.detail);
});
addEventListener("lab-failed", (event) => {
    stop(`The laboratory has stopped: ${event.detail}.`);
});
addEventListener("lab-stopped", (event) => stop(event.detail));

const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

/** What this browser keeps of this version of the site, see offline.js. scripts/web puts in the version. */
const CACHE = "lab-VERSION";
const KEPT = "lab.wasm";
const wasm = { headers: { "Content-Type": "application/wasm" } };

/** What is done with copies, where the browser keeps any: private windows and full disks do without. */
async function keeping(action) {
    try {
        return await action();
    } catch (why) {
        console.warn(why);
        return undefined;
    }
}

/** The program: the copy of an earlier visit, or unpacked while it arrives, and then kept. */
async function program() {
    const known = await keeping(() => caches.match(KEPT, { cacheName: CACHE }));
    if (known) {
        bar.removeAttribute("value");
        return known;
    }
    const { default: prepare, Unpacker } = await import("./unpack.js");
    const [response] = await Promise.all([fetch("lab.bin"), prepare()]);
    if (!response.ok) throw new Error(`lab.bin: ${response.status} ${response.statusText}`);
    const whole = Number(response.headers.get("Content-Length"));
    const unpacker = Unpacker.new();
    let done = 0;
    const unpack = new TransformStream({
        transform(bytes, onward) {
            done += bytes.length;
            if (whole > 0) bar.value = done / whole;
            say(`${megabytes(done)} of ${megabytes(Math.max(whole, done))} MB`);
            onward.enqueue(unpacker.more(bytes));
        },
        flush() {
            const ended = unpacker.ended();
            unpacker.free();
            if (!ended) throw new Error("lab.bin arrived in part");
        },
    });
    const [now, later] = response.body.pipeThrough(unpack).tee();
    keeping(async () => (await caches.open(CACHE)).put(KEPT, new Response(later, wasm)));
    return new Response(now, wasm);
}

/** What stands for the graphics card where the browser does not answer within ten seconds: some never do. */
const SILENT = Symbol("silent");
const silence = () => new Promise((done) => setTimeout(done, 10000, SILENT));

async function start() {
    if (!globalThis.isSecureContext) {
        return refuse("Browsers give pages a graphics card over https or from this computer alone: open this page so.");
    }
    const adapter = await Promise.race([navigator.gpu?.requestAdapter(), silence()]);
    if (adapter === SILENT) {
        return refuse("This browser does not say whether it has WebGPU. Start it anew, or try another one.");
    }
    if (!adapter) {
        return refuse("The laboratory draws with WebGPU, which this browser does not offer. Chrome and Edge from 113, "
            + "Safari from 26 and Firefox from 141 do on most computers.");
    }
    const { default: run } = await import("./lab.js");
    await run({ module_or_path: program() });
    // From now on, the site needs no network.
    navigator.serviceWorker?.register("offline.js").catch((why) => console.warn(why));
}

start().catch((why) => {
    console.error(why);
    if (!before.hidden) refuse(`The laboratory could not be loaded: ${why.message ?? why}`);
});
