// SPDX-License-Identifier: GPL-3.0-or-later
// What every page needs: elements, words for numbers, tabs.
'use strict';

const $ = (id) => document.getElementById(id);
const whole = (n) => Number(n).toLocaleString('en-US');
const plural = (n, one, many) => whole(n) + ' ' + (Number(n) === 1 ? one : many);

function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name === 'class') element.className = value;
    else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value !== false && value !== null) element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

function number(value) {
  if (value === null || value === undefined) return 'not finite';
  if (value === 0 || Number.isInteger(value) && Math.abs(value) < 1e15) return whole(value);
  const size = Math.abs(value);
  if (size >= 1000 && size < 1e9) return value.toLocaleString('en-US', {maximumSignificantDigits: 7});
  return size >= 1e-4 && size < 1e9 ? String(Number(value.toPrecision(7)))
                                    : value.toExponential(6).replace(/\.?0+e/, 'e');
}

// A whole power of two may be beyond a double where the product is not.
function times_power(value, exponent) {
  const first = Math.trunc(exponent / 2);
  return value * Math.pow(2, first) * Math.pow(2, exponent - first);
}
function press(id, on) {
  $(id).setAttribute('aria-pressed', on ? 'true' : 'false');
}

// Tabs 'tab-NAME' with panels 'panel-NAME', in a holder 'tabs'. shown(name) follows a change.
class Tabs {
  constructor(names, shown) {
    this.names = names;
    this.shown = shown;
    for (const name of names) $('tab-' + name).onclick = () => this.show(name);
    $('tabs').addEventListener('keydown', (event) => this.key(event));
  }

  show(name) {
    for (const tab of this.names) {
      $('tab-' + tab).setAttribute('aria-selected', tab === name ? 'true' : 'false');
      $('tab-' + tab).tabIndex = tab === name ? 0 : -1;
      $('panel-' + tab).hidden = tab !== name;
    }
    this.shown(name);
  }

  key(event) {
    const by = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (!by) return;
    const at = this.names.findIndex((tab) => $('tab-' + tab).tabIndex === 0);
    const next = this.names[(at + by + this.names.length) % this.names.length];
    this.show(next);
    $('tab-' + next).focus();
  }
}
