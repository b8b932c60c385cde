// Renders a job of probebench (docs/external.md) with three.js in headless Chromium: node render.mjs JOB.json
import { readFileSync, writeFileSync } from 'node:fs';
import { openBrowser, run } from './browser.mjs';
import { encodeExr } from './exr.mjs';

async function savePicture(job, request, path) {
  const index = Number(path.slice('/picture/'.length));
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  const bytes = Buffer.concat(chunks);
  const rgb = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  writeFileSync(job.frames[index].image, encodeExr(job.image.width, job.image.height, rgb));
}

async function render(job) {
  const { backend, chromium } = job.technique.settings;
  const browser = await openBrowser({
    backend,
    chromium,
    fileOf: (path) => (path === '/scene.glb' ? job.scene.file : null),
    save: (request, path) => savePicture(job, request, path),
  });
  try {
    const page = await browser.newPage();
    const about = await page.evaluate((j) => window.technique.load(j), job);
    browser.requireRenderer(about.renderer);
    await page.evaluate(() => window.technique.renderPictures());
    if (job.timing) {
      const times = await page.evaluate((n) => window.technique.measure(n), job.timing.repetitions);
      const program = `three.js r${about.three}, Chromium ${browser.version}, ${about.renderer}`;
      writeFileSync(job.timing.file, JSON.stringify({ timing_version: 1, program, ...times }));
    }
  } finally {
    await browser.close();
  }
}

await run(async () => {
  if (process.argv.length !== 3) throw new Error('usage: render JOB.json');
  await render(JSON.parse(readFileSync(process.argv[2], 'utf8')));
});
