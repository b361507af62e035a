// What the program asks of its page.

export function query() {
    return location.search;
}

export function fragment() {
    return location.hash;
}

export function place() {
    return location.href.split(/[?#]/, 1)[0];
}

// With another link in the same tab, only what is behind # changes.
addEventListener("hashchange", () => location.reload());

function event(name, detail) {
    globalThis.dispatchEvent(new CustomEvent(name, { detail }));
}

export function tell(line) {
    console.warn(line);
    event("lab-told", line);
}

let unsaved = false;
addEventListener("beforeunload", (event) => {
    if (unsaved) event.preventDefault();
});

export function titled(title, isUnsaved) {
    document.title = title;
    unsaved = isUnsaved;
}

export function shown() {
    event("lab-shown");
}

// What happens around the program, until it attends.
let attending = null;
const happenings = [];

function happened(what, subject = "", bytes = new Uint8Array()) {
    if (attending) attending(what, subject, bytes);
    else happenings.push([what, subject, bytes]);
}

export function attend(call) {
    attending = call;
    happenings.splice(0).forEach((happening) => call(...happening));
}

addEventListener("visibilitychange", () => {
    if (document.visibilityState === "hidden") happened("leaving");
});

// The ends of the program: a panic, a lost graphics card.
let broken = false;
let over = false;

export function failed(line) {
    console.error(line);
    broken = true;
    if (!over) event("lab-failed", line);
}

const requestDevice = globalThis.GPUAdapter?.prototype.requestDevice;
if (requestDevice) {
    GPUAdapter.prototype.requestDevice = async function (...wishes) {
        const device = await requestDevice.apply(this, wishes);
        device.lost.then(() => {
            broken = true;
            // The program, which may sleep, learns of it in its next frame.
            happened("lost");
        });
        return device;
    };
}

export async function stopped(line) {
    if (over) return;
    over = true;
    event("lab-stopped", line);
    if (!unsaved) return;
    const before = copies;
    // The program writes the copy of unsaved work in the next moments.
    for (let i = 0; i < 50 && copies === before; ++i) {
        await new Promise((done) => setTimeout(done, 100));
    }
    const kept = copies > before;
    unsaved = !kept;
    event("lab-stopped", line + (kept
        ? " The unsaved work is kept: the page offers it once it is loaded again."
        : " The browser had no room for a copy of the unsaved work."));
}

// Other tabs of the site. Each holds a lock with its number, and one for each file that is its own.
const TAB = crypto.randomUUID();
const NUMBER = crypto.getRandomValues(new Uint32Array(1))[0];
const HELD = "file:";
const held = new Map();
const elsewhere = new Set();
const channel = new BroadcastChannel("lights-camera-models");

export function process() {
    return NUMBER;
}

/** Takes a lock. Returns what gives it back. */
function take(name, options = {}) {
    return new Promise((taken, failed) => {
        navigator.locks.request(name, options, () => new Promise((free) => taken(free))).catch(failed);
    });
}

// What a page leaves behind in its tab for the next one there.
const LEFT = "lab-left";

addEventListener("pagehide", ({ persisted }) => {
    try {
        if (!persisted) sessionStorage.setItem(LEFT, NUMBER);
    } catch (why) {
        console.warn(`The next page will not know of this one: ${why.message ?? why}`);
    }
});

/** Waits until the page that was left for this one has given back its locks: it is no other tab. */
async function outlivePredecessor() {
    const left = sessionStorage.getItem(LEFT);
    if (left === null) return;
    sessionStorage.removeItem(LEFT);
    const free = await take(`tab:${left}`, { signal: AbortSignal.timeout(10_000) }).catch(() => null);
    free?.();
}

// One tab starts after the other, so that each sees what the others have.
let begun = () => {};
let tabs = [];
try {
    await outlivePredecessor();
    begun = (await take("start", { signal: AbortSignal.timeout(10_000) }).catch(() => null)) ?? begun;
    const locks = (await navigator.locks.query()).held.map((lock) => lock.name);
    tabs = locks.filter((name) => name.startsWith("tab:")).map((name) => name.slice("tab:".length));
    locks.filter((name) => name.startsWith(HELD)).forEach((name) => elsewhere.add(name.slice(HELD.length)));
    await take(`tab:${NUMBER}`);
    if (tabs.length > 0) happened("tabs");
} catch (why) {
    console.warn(`This browser does not tell tabs apart: ${why.message ?? why}`);
}

export function hold(path) {
    if (elsewhere.has(path)) return false;
    // It may be on its way back from an earlier use.
    held.set(path, take(HELD + path).catch(() => null));
    channel.postMessage({ held: path });
    return true;
}

export function release(path) {
    held.get(path)?.then((free) => free?.());
    held.delete(path);
    channel.postMessage({ released: path });
}

// The files that outlive the page: a copy here until the program has read them, and the database of the browser. Each has a mark
// that says who wrote it.
const STORE = "files";
const RECOVERY = "/Data/recovery";
const kept = new Map();
/** The marks of the other tabs' files that this page knows. */
const marks = new Map();
/** How many changes of a file are on their way. */
const pending = new Map();
let writes = 0;
/** How many copies of unsaved work were kept. */
let copies = 0;
let database = null;
let left = Infinity;
/** Until when the browser is taken to have no room. */
let fullUntil = 0;

function settled(request) {
    return new Promise((done, failed) => {
        request.onsuccess = () => done(request.result);
        request.onerror = () => failed(request.error);
    });
}

async function openDatabase() {
    const request = indexedDB.open("lights-camera-models", 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    const opened = await settled(request);
    const store = opened.transaction(STORE).objectStore(STORE);
    const [paths, files] = await Promise.all([settled(store.getAllKeys()), settled(store.getAll())]);
    paths.forEach((path, i) => {
        // Earlier versions kept bytes alone.
        kept.set(path, files[i].bytes ?? files[i]);
        marks.set(path, files[i].mark ?? "");
    });
    return opened;
}

/** Asks how much room there is. */
async function measure() {
    const { quota, usage } = await navigator.storage?.estimate?.() ?? {};
    if (quota !== undefined) left = Math.max(quota - usage, 0);
}

try {
    database = await openDatabase();
    await measure();
} catch (why) {
    console.warn(`This browser keeps no files for the page: ${why.message ?? why}`);
    if (!database) happened("memory", why.message ?? `${why}`);
}

// The scene of this site that the address names: loaded before the program, which cannot wait.
const MOST_BYTES = 1 << 20;
const MOST_SECONDS = 10;
const named = new URLSearchParams(location.search).get("scene");
let loaded = null;
let problem = null;

async function load(name) {
    const address = new URL(name, document.baseURI);
    if (address.origin !== location.origin) throw new Error("a page opens scenes of its own site alone");
    const response = await fetch(address, { redirect: "error", signal: AbortSignal.timeout(1000 * MOST_SECONDS) });
    if (!response.ok) throw new Error(`the site answers ${response.status} ${response.statusText}`.trim());
    const reader = response.body.getReader();
    const parts = [];
    let length = 0;
    for (;;) {
        const { done, value } = await reader.read();
        if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
        length += value.length;
        if (length > MOST_BYTES) {
            reader.cancel();
            throw new Error(`it is larger than ${MOST_BYTES >> 20} MiB, the most that a page loads`);
        }
        parts.push(value);
    }
}

function reason(why) {
    if (why.name === "TimeoutError") return `it did not arrive within ${MOST_SECONDS} seconds`;
    // What browsers say of networks differs, and names no cause.
    return why instanceof TypeError ? "it could not be loaded from the site" : why.message;
}

if (named?.endsWith(".json")) {
    try {
        loaded = await load(named);
    } catch (why) {
        problem = reason(why);
    }
}

export function loadedBytes(name) {
    return name === named ? loaded : null;
}

export function loadProblem(name) {
    return name === named ? problem : null;
}

export function room() {
    return performance.now() < fullUntil ? 0 : left;
}

/** Keeps a file, or no longer: bytes are null. What another tab has written to it unheard stays. */
function store(path, bytes) {
    if (!database) return;
    let transaction;
    try {
        transaction = database.transaction(STORE, "readwrite");
    } catch (why) {
        // The browser has closed the database, perhaps because its user deleted the data of the site.
        console.warn(`The browser does not keep ${path}: ${why.message}`);
        setTimeout(() => happened("unkept", path), 0);
        return;
    }
    const known = marks.get(path) ?? "";
    const mark = `${TAB} ${++writes}`;
    let theirs = null;
    pending.set(path, (pending.get(path) ?? 0) + 1);
    const ended = () => pending.set(path, pending.get(path) - 1);
    left = Math.max(left - (bytes?.length ?? 0), 0);
    const files = transaction.objectStore(STORE);
    files.get(path).onsuccess = ({ target: { result: there } }) => {
        const mine = (there?.mark ?? "").startsWith(TAB);
        if (there && !mine && (there.mark ?? "") !== known) theirs = there;
        else if (bytes) files.put({ bytes, mark }, path);
        else files.delete(path);
    };
    transaction.oncomplete = () => {
        ended();
        fullUntil = 0;
        measure();
        if (theirs) {
            marks.set(path, theirs.mark);
            happened("clash", path, theirs.bytes ?? theirs);
            return;
        }
        if (bytes && path.startsWith(RECOVERY)) ++copies;
        channel.postMessage({ path, mark, bytes });
    };
    transaction.onabort = () => {
        ended();
        console.warn(`The browser does not keep ${path}: ${transaction.error?.message}`);
        fullUntil = performance.now() + 10_000;
        measure();
        happened("unkept", path);
    };
}

channel.onmessage = ({ data: { path, mark, bytes, held, released } }) => {
    if (held !== undefined) elsewhere.add(held);
    else if (released !== undefined) elsewhere.delete(released);
    // What is on its way from here finds out by itself.
    else if (!pending.get(path)) {
        if (bytes) marks.set(path, mark);
        else marks.delete(path);
        happened(bytes ? "written" : "removed", path, bytes ?? undefined);
    }
};

export function keptPaths() {
    // Once the program has locked what is its own, the next tab may start.
    setTimeout(begun, 0);
    return [...kept.keys()];
}

export function keptBytes(path) {
    const bytes = kept.get(path);
    kept.delete(path);
    return bytes;
}

export function keep(path, bytes) {
    store(path, bytes.slice());
}

export function forget(path) {
    store(path, null);
}

// Shaders that a page draws with for the first time. A page that ends meanwhile leaves them noted, and later ones do without.
const TRYING = "lab-trying:";
const FATAL = "lab-fatal";
const MOST_FATAL = 64;

function readTrials() {
    const fatal = JSON.parse(localStorage.getItem(FATAL) ?? "[]");
    const noted = Object.keys(localStorage).filter((key) => key.startsWith(TRYING));
    const ended = noted.filter((key) => !tabs.includes(key.slice(TRYING.length)));
    const found = ended.flatMap((key) => localStorage.getItem(key).split("\n"));
    new Set(found.map((name) => name.replace(/^\S+ /, ""))).forEach((file) => happened("fatal", file));
    const all = [...new Set([...fatal, ...found])].slice(-MOST_FATAL);
    if (found.length > 0) localStorage.setItem(FATAL, JSON.stringify(all));
    ended.forEach((key) => localStorage.removeItem(key));
    return all;
}

let trials = [];
try {
    trials = readTrials();
} catch (why) {
    console.warn(`This browser keeps no notes for the page: ${why.message ?? why}`);
}

export function fatalTrials() {
    return trials;
}

/** Longer than a picture takes, in milliseconds. */
const LONG = 5_000;
let notedAt = 0;

export function noteTrials(names) {
    notedAt = performance.now();
    try {
        if (names) localStorage.setItem(TRYING + NUMBER, names);
        else localStorage.removeItem(TRYING + NUMBER);
    } catch (why) {
        console.warn(`A trial is not noted: ${why.message ?? why}`);
    }
}

addEventListener("pagehide", () => {
    // Who leaves in peace accuses nobody; who has waited for a picture in vain does.
    if (!broken && performance.now() - notedAt < LONG) noteTrials("");
});

export function download(name, bytes) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes.slice()]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

async function bring(files, brought) {
    for (const [i, file] of files.entries()) {
        brought(file.name, new Uint8Array(await file.arrayBuffer()), i + 1 === files.length);
    }
}

export function listen(brought) {
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
        event.preventDefault();
        bring([...event.dataTransfer.files], brought);
    });
}

export function after(milliseconds, call) {
    setTimeout(call, milliseconds);
}

// egui copies texts, and tells nobody whether it could.
const writeText = navigator.clipboard?.writeText;
if (writeText) {
    navigator.clipboard.writeText = async function (text) {
        try {
            await writeText.call(this, text);
            happened("copied", text);
        } catch (why) {
            happened("uncopied", text, new TextEncoder().encode(why.message ?? why));
            throw why;
        }
    };
}

export async function copyPicture(rgba, width, height) {
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba), width, height), 0, 0);
    const picture = canvas.convertToBlob({ type: "image/png" });
    try {
        await navigator.clipboard.write([new ClipboardItem({ "image/png": picture })]);
        happened("copied picture", `${width}×${height}`);
    } catch (why) {
        happened("uncopied picture", why.message ?? `${why}`);
    }
}
