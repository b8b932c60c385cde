// Times frames of builtin:mirrors with three.js in headless Chromium, for scripts/perf: node frames.mjs [FRAMES [MS]]
// Reads lines "SCENE.glb ITERATIONS TEXELS" from standard input and answers each with a line of JSON: milliseconds of a frame
// by the clock (median) and of processor time, of all of the browser's threads (mean). A cell is measured with FRAMES frames
// (default 5) and for MS milliseconds (default 500), at least. PICTURE.png as a fourth word: a screenshot of the last frame.
import { readFileSync, readdirSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { openBrowser, run } from './browser.mjs';

const kWarmUpFrames = 2; // the first compiles shaders

function parentOf(pid) {
  const stat = readFileSync(`/proc/${pid}/stat`, 'latin1');
  return Number(stat.slice(stat.lastIndexOf(')') + 2).split(' ')[1]);
}

// Milliseconds that each thread of all processes below this one has run.
function threadsOfChildren() {
  const tree = new Map([[process.pid, true]]);
  const isBelow = (pid) => {
    if (!tree.has(pid)) tree.set(pid, pid > 1 && isBelow(parentOf(pid)));
    return tree.get(pid);
  };
  const msOf = new Map();
  for (const name of readdirSync('/proc')) {
    if (!/^\d+$/.test(name) || Number(name) === process.pid) continue;
    for (const thread of unlessEnded(() => (isBelow(Number(name)) ? readdirSync(`/proc/${name}/task`) : []), [])) {
      const stat = unlessEnded(() => readFileSync(`/proc/${name}/task/${thread}/schedstat`, 'latin1'), '');
      if (stat) msOf.set(thread, Number(stat.split(' ')[0]) / 1e6);
    }
  }
  return msOf;
}

function unlessEnded(read, otherwise) {
  try {
    return read();
  } catch {
    return otherwise;
  }
}

// What threads have run since then; those that ended count nothing.
function cpuMsSince(before) {
  let ms = 0;
  for (const [thread, now] of threadsOfChildren()) ms += now - (before.get(thread) ?? 0);
  return ms;
}

// Until the browser has nothing left to do for the page that it opened, for 5 s at most.
async function untilQuiet() {
  for (let i = 0; i < 25; ++i) {
    const before = threadsOfChildren();
    await new Promise((resolve) => setTimeout(resolve, 200));
    if (cpuMsSince(before) < 10) return;
  }
}

const medianOf = (values) => {
  const sorted = values.toSorted((a, b) => a - b), middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
};

async function measureCell(browser, bounces, resolution, frames, ms, picture) {
  const page = await browser.newPage();
  const about = await page.evaluate((r) => window.technique.load(r), resolution);
  browser.requireRenderer(about.renderer);
  await page.evaluate((a) => window.technique.measure(...a), [bounces, kWarmUpFrames, 0]);
  await untilQuiet();
  const before = threadsOfChildren();
  const got = await page.evaluate((a) => window.technique.measure(...a), [bounces, frames, ms]);
  const cpuMs = cpuMsSince(before) / got.frameMs.length;
  if (picture) await page.locator('canvas').screenshot({ path: picture });
  await page.close();
  return {
    ms: medianOf(got.frameMs), cpu_ms: cpuMs, frames: got.frameMs.length, draws: got.draws, triangles: got.triangles,
    program: `three.js r${about.three}, Chromium ${browser.version}, ${about.renderer}`,
  };
}

await run(async () => {
  const [frames, ms] = [Number(process.argv[2] ?? 5), Number(process.argv[3] ?? 500)];
  let scene;
  const browser = await openBrowser({ module: 'mirrors.mjs', fileOf: (path) => (path === '/scene.glb' ? scene : null) });
  try {
    for await (const line of createInterface({ input: process.stdin })) {
      const [file, bounces, resolution, picture] = line.split(' ');
      const measure = () => measureCell(browser, Number(bounces), Number(resolution), frames, ms, picture);
      const isFirst = !scene;
      scene = file;
      if (isFirst) await measure(); // beside the browser, which is still starting: not counted
      console.log(JSON.stringify(await measure()));
    }
  } finally {
    await browser.close();
  }
});
