// The binary parts of the page: base64 in it, or in scripts beside it that are loaded when they are needed (a page from a
// disk may load scripts, but not fetch files).

let folder = null;
export const setBlobFolder = (name) => {
  folder = name;
};

const waiting = new Map();
globalThis.probebenchBlob = (number, text) => waiting.get(number)?.(text);

function loadBeside(number) {
  return new Promise((resolve, reject) => {
    waiting.set(number, resolve);
    const script = document.createElement("script");
    script.src = `${encodeURIComponent(folder)}/${number}.js`;
    script.onerror = () => reject(new Error(`${folder}/${number}.js is not there`));
    script.onload = () => script.remove();
    document.head.append(script);
  });
}

export async function blob(number) {
  const inline = document.getElementById(`blob-${number}`);
  const text = inline ? inline.textContent : await loadBeside(number);
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
