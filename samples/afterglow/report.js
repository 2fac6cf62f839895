// SPDX-License-Identifier: MIT
'use strict';
for (const range of document.querySelectorAll('input[type=range]')) {
  const wipe = range.parentElement.querySelector('.wipe');
  range.addEventListener('input', () => wipe.style.setProperty('--cut', range.value + '%'));
}
for (const head of document.querySelectorAll('th')) {
  head.addEventListener('click', () => {
    const body = head.closest('table').tBodies[0];
    const column = head.cellIndex;
    const sign = head.dataset.sign === '1' ? -1 : 1;
    head.dataset.sign = String(sign);
    const key = (row) => {
      const text = row.cells[column].textContent;
      const number = parseFloat(text);
      return isNaN(number) ? text : number;
    };
    const rows = Array.from(body.rows).sort((a, b) => {
      const x = key(a), y = key(b);
      return sign * (x < y ? -1 : x > y ? 1 : 0);
    });
    body.append(...rows);
  });
}
