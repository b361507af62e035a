// Keeps the site for when there is no network; start.js keeps the program. scripts/web puts in the version and the names of
// the files.
const CACHE = "lab-VERSION";
const FILES = ["FILES"];

addEventListener("install", (event) => {
    event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(FILES)));
    skipWaiting();
});

addEventListener("activate", (event) => {
    const drop = (names) => Promise.all(names.filter((name) => name !== CACHE).map((name) => caches.delete(name)));
    event.waitUntil(caches.keys().then(drop).then(() => clients.claim()));
});

addEventListener("fetch", (event) => {
    const { request } = event;
    if (request.method !== "GET" || !request.url.startsWith(registration.scope)) return;
    // The address may name a scene.
    event.respondWith(caches.match(request, { ignoreSearch: true }).then((known) => known ?? fetch(request)));
});
