// SPDX-License-Identifier: MIT
// The scale of colours, as the tools have it.
import { scene } from './data.js';

/** Red, green, blue (0 to 255) for a share of the scale. */
export function colourOf(share) {
  if (!(share <= 1)) return scene.beyond;
  const place = Math.max(0, share) * (scene.stops.length - 1);
  const below = Math.min(scene.stops.length - 2, Math.floor(place));
  const part = place - below;
  return scene.stops[below].map((value, k) => Math.round((1 - part) * value + part * scene.stops[below + 1][k]));
}

export const css = ([red, green, blue]) => `rgb(${red} ${green} ${blue})`;

export function drawLegend() {
  const bar = document.getElementById('bar');
  const context = bar.getContext('2d');
  for (let x = 0; x < bar.width; ++x) {
    context.fillStyle = css(colourOf(x / (bar.width - 1)));
    context.fillRect(x, 0, 1, 1);
  }
  document.getElementById('beyond-box').style.background = css(scene.beyond);
}
