// What the program asks of its page.

export function query() {
    return location.search;
}

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
