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

export function failed(line) {
    console.error(line);
    event("lab-failed", line);
}

// The files that outlive the page: a copy here, and the database of the browser.
const STORE = "files";
const kept = new Map();
let database = null;

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
    paths.forEach((path, i) => kept.set(path, files[i]));
    return opened;
}

try {
    database = await openDatabase();
} catch (why) {
    console.warn(`This browser keeps no files for the page: ${why.message ?? why}`);
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

function store(change) {
    if (!database) return;
    const transaction = database.transaction(STORE, "readwrite");
    transaction.onabort = () => tell(`The browser has no room to keep a file: ${transaction.error?.message}`);
    change(transaction.objectStore(STORE));
}

export function keptPaths() {
    return [...kept.keys()];
}

export function keptBytes(path) {
    const bytes = kept.get(path);
    kept.delete(path);
    return bytes;
}

export function keep(path, bytes) {
    const copy = bytes.slice();
    store((files) => files.put(copy, path));
}

export function forget(path) {
    store((files) => files.delete(path));
}

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

export async function copyPicture(rgba, width, height) {
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba), width, height), 0, 0);
    const picture = canvas.convertToBlob({ type: "image/png" });
    try {
        await navigator.clipboard.write([new ClipboardItem({ "image/png": picture })]);
    } catch (why) {
        console.warn(`The picture was not copied: ${why.message}`);
    }
}
