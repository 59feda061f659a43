// SPDX-License-Identifier: GPL-3.0-or-later
// A tree of two levels that makes elements only for the rows in sight.
'use strict';

const ROW_PX = 34;
const ROWS_BEYOND = 8;  // made above and below what is in sight

class RowList {
  // paint(row, element) fills an element; act(row) is a click or Enter.
  constructor(holder, paint, act, fold) {
    this.holder = holder;
    this.paint = paint;
    this.act = act;
    this.fold = fold;
    this.rows = [];
    this.active = 0;
    this.inner = document.createElement('div');
    this.inner.className = 'rows';
    holder.append(this.inner);
    holder.tabIndex = 0;
    holder.setAttribute('role', 'tree');
    holder.addEventListener('scroll', () => this.draw());
    holder.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(holder);
  }

  set_rows(rows) {
    this.rows = rows;
    this.active = Math.min(this.active, Math.max(0, rows.length - 1));
    this.inner.style.height = rows.length * ROW_PX + 'px';
    this.draw();
  }

  // A row out of sight comes into the middle, or to the nearest end.
  activate(index, middle) {
    if (index < 0 || index >= this.rows.length) return;
    this.active = index;
    const top = index * ROW_PX;
    const seen = top >= this.holder.scrollTop &&
        top + ROW_PX <= this.holder.scrollTop + this.holder.clientHeight;
    if (middle && !seen) this.holder.scrollTop = top - this.holder.clientHeight / 2;
    if (top < this.holder.scrollTop) this.holder.scrollTop = top;
    const bottom = top + ROW_PX - this.holder.clientHeight;
    if (bottom > this.holder.scrollTop) this.holder.scrollTop = bottom;
    this.draw();
  }

  key(event) {
    const page = Math.max(1, Math.floor(this.holder.clientHeight / ROW_PX) - 1);
    const row = this.rows[this.active];
    const moves = {ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page};
    if (moves[event.key]) {
      this.activate(Math.min(this.rows.length - 1, Math.max(0, this.active + moves[event.key])));
    } else if (event.key === 'Home' || event.key === 'End') {
      this.activate(event.key === 'Home' ? 0 : this.rows.length - 1);
    } else if (row && (event.key === 'Enter' || event.key === ' ')) {
      this.act(row);
    } else if (row && (event.key === 'ArrowRight' || event.key === 'ArrowLeft')) {
      this.fold(row, event.key === 'ArrowRight');
    } else {
      return;
    }
    event.preventDefault();
  }

  draw() {
    const first = Math.max(0, Math.floor(this.holder.scrollTop / ROW_PX) - ROWS_BEYOND);
    const shown = Math.ceil(this.holder.clientHeight / ROW_PX) + 2 * ROWS_BEYOND;
    const last = Math.min(this.rows.length, first + shown);
    const elements = [];
    for (let i = first; i < last; ++i) elements.push(this.element(i));
    this.inner.replaceChildren(...elements);
    this.holder.setAttribute('aria-activedescendant', this.rows.length ? this.row_id(this.active) : '');
  }

  row_id(index) {
    return this.holder.id + '-row' + index;
  }

  element(index) {
    const element = document.createElement('div');
    element.id = this.row_id(index);
    element.className = 'row' + (index === this.active ? ' active' : '');
    element.style.top = index * ROW_PX + 'px';
    element.setAttribute('role', 'treeitem');
    element.addEventListener('click', () => {
      this.active = index;
      this.act(this.rows[index]);
    });
    this.paint(this.rows[index], element);
    return element;
  }
}
