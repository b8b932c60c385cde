// Renders a job of probebench (docs/external.md) with three.js in headless Chromium: node render.mjs JOB.json
import { accessSync, constants, readFileSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { delimiter, dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { encodeExr } from './exr.mjs';

const kSkipped = 77;
const here = dirname(fileURLToPath(import.meta.url));

class Skip extends Error {}

// Where WebGL is drawn; `want` is what its renderer's name must tell.
const backends = {
  llvmpipe: {
    args: ['--use-angle=gl-egl', '--ignore-gpu-blocklist'],
    env: { LIBGL_ALWAYS_SOFTWARE: '1', GALLIUM_DRIVER: 'llvmpipe', EGL_PLATFORM: 'surfaceless' },
    want: /llvmpipe/,
  },
  swiftshader: { args: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'], env: {}, want: /SwiftShader/ },
  gpu: { args: ['--ignore-gpu-blocklist'], env: {}, want: /./ },
};

function isExecutable(path) {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

function findChromium(settings) {
  if (settings.chromium) return settings.chromium;
  for (const name of ['chromium', 'chromium-browser', 'google-chrome'])
    for (const folder of (process.env.PATH ?? '').split(delimiter))
      if (isExecutable(join(folder, name))) return join(folder, name);
  throw new Skip('Chromium is not installed (Debian: apt-get install chromium)');
}

// The page and what it loads, and where it leaves its pictures; on the loop-back interface only.
async function serve(job) {
  const types = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript' };
  const fileOf = (path) => {
    if (path === '/') return join(here, 'page.html');
    if (path === '/page.mjs') return join(here, 'page.mjs');
    if (path === '/scene.glb') return job.scene.file;
    if (path.startsWith('/three/') && normalize(path) === path) return join(here, 'node_modules', path);
    return null;
  };
  const save = async (request, index) => {
    const chunks = [];
    for await (const chunk of request) chunks.push(chunk);
    const bytes = Buffer.concat(chunks);
    const rgb = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    writeFileSync(job.frames[index].image, encodeExr(job.image.width, job.image.height, rgb));
  };
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://127.0.0.1').pathname;
    try {
      if (request.method === 'POST' && path.startsWith('/picture/')) {
        await save(request, Number(path.slice('/picture/'.length)));
        return response.writeHead(204).end();
      }
      const file = fileOf(path);
      if (!file) return response.writeHead(404).end();
      // Isolated pages have a finer clock.
      const headers = {
        'Content-Type': types[extname(path) || '.html'] ?? 'application/octet-stream',
        'Cross-Origin-Opener-Policy': 'same-origin',
        'Cross-Origin-Embedder-Policy': 'require-corp',
      };
      return response.writeHead(200, headers).end(readFileSync(file));
    } catch (error) {
      return response.writeHead(500).end(String(error));
    }
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  return { url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

async function render(job) {
  const settings = job.technique.settings;
  const backend = backends[settings.backend ?? 'llvmpipe'];
  if (!backend) throw new Error(`setting backend wants one of ${Object.keys(backends)}, got ${settings.backend}`);
  const site = await serve(job);
  const browser = await chromium.launch({
    executablePath: findChromium(settings),
    headless: true,
    // The driver would let WebGL fall back to SwiftShader where another backend was asked for.
    ignoreDefaultArgs: backend === backends.swiftshader ? [] : ['--enable-unsafe-swiftshader'],
    args: ['--no-sandbox', '--use-gl=angle', '--disable-gpu-watchdog', ...backend.args],
    env: { ...process.env, ...backend.env },
  });
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(0);
    let failure = null;
    page.on('pageerror', (error) => (failure ??= error));
    page.on('console', (message) => {
      if (['warning', 'error'].includes(message.type())) console.error(message.text());
    });
    await page.goto(site.url);
    await page.waitForFunction(() => window.technique || window.failure);
    if (failure) throw failure;
    const about = await page.evaluate((j) => window.technique.load(j), job);
    if (!backend.want.test(about.renderer))
      throw new Skip(`WebGL is drawn by ${about.renderer}, not by ${settings.backend ?? 'llvmpipe'}`);
    await page.evaluate(() => window.technique.renderPictures());
    if (job.timing) {
      const times = await page.evaluate((n) => window.technique.measure(n), job.timing.repetitions);
      const program = `three.js r${about.three}, Chromium ${browser.version()}, ${about.renderer}`;
      writeFileSync(job.timing.file, JSON.stringify({ timing_version: 1, program, ...times }));
    }
  } finally {
    await browser.close();
    site.close();
  }
}

try {
  if (process.argv.length !== 3) throw new Error('usage: render JOB.json');
  await render(JSON.parse(readFileSync(process.argv[2], 'utf8')));
} catch (error) {
  console.error(String(error.message ?? error).split('\n')[0].replace(/^page\.evaluate: (Error: )?/, ''));
  process.exit(error instanceof Skip ? kSkipped : 1);
}
