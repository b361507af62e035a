// What tests see of a page, and what they keep from it. Runs before the scripts of each page.
globalThis.seen = { copied: [], pictures: [], told: [], refused: null, isFull: false, device: null };
addEventListener("lab-told", ({ detail }) => seen.told.push(detail));
// Other pages than those of the site may lack all of this.
if (globalThis.isSecureContext && navigator.clipboard && globalThis.GPUAdapter) {
    navigator.clipboard.writeText = async (text) => {
        if (seen.refused) throw new Error(seen.refused);
        seen.copied.push(text);
    };
    const convert = OffscreenCanvas.prototype.convertToBlob;
    OffscreenCanvas.prototype.convertToBlob = async function (options) {
        const blob = await convert.call(this, options);
        const reader = new FileReader();
        reader.onload = () => seen.pictures.push(reader.result.split(",")[1]);
        reader.readAsDataURL(blob);
        return blob;
    };
    const estimate = StorageManager.prototype.estimate;
    StorageManager.prototype.estimate = async function () {
        const { quota, usage } = await estimate.call(this);
        return { quota: seen.isFull ? usage : quota, usage };
    };
    const requestDevice = GPUAdapter.prototype.requestDevice;
    GPUAdapter.prototype.requestDevice = async function (...wishes) {
        seen.device = await requestDevice.apply(this, wishes);
        return seen.device;
    };
}
