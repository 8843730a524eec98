// SPDX-License-Identifier: MIT
// node bundle.mjs OUT.cpp: the page with its style and its script in it, three.js included, as the string of a C++ file.
// Run where node_modules has what package-lock.json names.
import { readFile, writeFile } from 'node:fs/promises';
import { build } from 'esbuild';

const [, , out] = process.argv;

/** A text as adjacent C++ literals: printable ASCII as it is, everything else as octal. */
function literal(text) {
  const bytes = Buffer.from(text, 'utf8');
  const pieces = [];
  let piece = '';
  for (const byte of bytes) {
    const character = String.fromCharCode(byte);
    if (character === '"' || character === '\\') piece += `\\${character}`;
    else if (byte >= 32 && byte < 127) piece += character;
    else piece += `\\${byte.toString(8).padStart(3, '0')}`;
    if (piece.length > 4000) {
      pieces.push(piece);
      piece = '';
    }
  }
  pieces.push(piece);
  return pieces.map((each) => `    "${each}"`).join('\n');
}

const bundled = await build({
  entryPoints: ['main.js'], bundle: true, minify: true, format: 'iife', write: false, charset: 'ascii', legalComments: 'inline',
});
const script = bundled.outputFiles[0].text.replaceAll('</script', '<\\/script');
const style = await readFile('page.css', 'utf8');
const html = await readFile('page.html', 'utf8');
const page = html.replace('@@STYLE@@', () => style).replace('@@SCRIPT@@', () => script);
await writeFile(out, `// SPDX-License-Identifier: MIT
// Made by bundle.mjs: tools/deviation/page, and three.js (MIT, https://threejs.org).
#include "deviation/report_page.h"

namespace meshbound::tools {
namespace {

constexpr char page[] =
${literal(page)};

}  // namespace

std::optional<std::string_view> report_page() { return std::string_view(page, sizeof page - 1); }

}  // namespace meshbound::tools
`);
