// Headless Chromium with WebGL drawn by a chosen GL, and the server of the pages that it shows, on the loop-back interface only.
import { accessSync, constants, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { delimiter, dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));

// Something that is needed is not installed: exit code 77.
export class Skip extends Error {}

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

function findChromium() {
  for (const name of ['chromium', 'chromium-browser', 'google-chrome'])
    for (const folder of (process.env.PATH ?? '').split(delimiter))
      if (isExecutable(join(folder, name))) return join(folder, name);
  throw new Skip('Chromium is not installed (Debian: apt-get install chromium)');
}

// Serves page.html with `module` as its program, what lies beside it, three.js, and what fileOf(path) gives besides.
// save(request, path) takes what the page posts.
async function serve({ module, fileOf, save }) {
  const types = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript' };
  const ownFile = (path) => {
    if (path === '/') return join(here, 'page.html');
    if (path === '/page.mjs') return join(here, module);
    if (/^\/[a-z]+\.mjs$/.test(path)) return join(here, path);
    if (path.startsWith('/three/') && normalize(path) === path) return join(here, 'node_modules', path);
    return null;
  };
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://127.0.0.1').pathname;
    try {
      if (request.method === 'POST') {
        await save(request, path);
        return response.writeHead(204).end();
      }
      const file = fileOf(path) ?? ownFile(path);
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

// A page has window.technique once it is open; requireRenderer() throws if its GL is not the one asked for.
export async function openBrowser({ backend: name = 'llvmpipe', chromium: program, module = 'page.mjs', fileOf = () => null, save }) {
  const backend = backends[name];
  if (!backend) throw new Error(`setting backend wants one of ${Object.keys(backends)}, got ${name}`);
  const executablePath = program ?? findChromium();
  const site = await serve({ module, fileOf, save });
  const browser = await chromium.launch({
    executablePath,
    headless: true,
    // The driver would let WebGL fall back to SwiftShader where another backend was asked for.
    ignoreDefaultArgs: name === 'swiftshader' ? [] : ['--enable-unsafe-swiftshader'],
    args: ['--no-sandbox', '--use-gl=angle', '--disable-gpu-watchdog', ...backend.args],
    env: { ...process.env, ...backend.env },
  });
  return {
    version: browser.version(),
    async newPage() {
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
      return page;
    },
    requireRenderer(renderer) {
      if (!backend.want.test(renderer)) throw new Skip(`WebGL is drawn by ${renderer}, not by ${name}`);
    },
    async close() {
      await browser.close();
      site.close();
    },
  };
}

const kSkipped = 77;

// Runs a program's main function; ends with one sentence where it throws.
export async function run(main) {
  try {
    await main();
  } catch (error) {
    console.error(String(error.message ?? error).split('\n')[0].replace(/^page\.evaluate: (Error: )?/, ''));
    process.exit(error instanceof Skip ? kSkipped : 1);
  }
}
