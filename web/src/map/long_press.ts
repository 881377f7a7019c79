// SPDX-License-Identifier: MIT

const LONG_MS = 500;
const STILL_PX = 10;

/** Tells of a finger or a mouse button that stays down at one place of `element`, and keeps the click after it from others. */
export function onLongPress(element: HTMLElement, pressed: (clientX: number, clientY: number) => void): () => void {
  let timer = 0;
  let from: PointerEvent | null = null;
  let wasLong = false;
  const off = new AbortController();
  const give_up = () => {
    clearTimeout(timer);
    from = null;
  };
  const down = (event: PointerEvent) => {
    const isSecond = from !== null;
    give_up();
    wasLong = false;
    if (isSecond || event.button !== 0 || (event.target as Element).closest(".leaflet-marker-icon")) return;
    from = event;
    timer = window.setTimeout(() => {
      wasLong = true;
      pressed(event.clientX, event.clientY);
    }, LONG_MS);
  };
  const move = (event: PointerEvent) => {
    if (from && Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > STILL_PX) give_up();
  };
  const click = (event: MouseEvent) => {
    if (wasLong) event.stopPropagation();
    wasLong = false;
  };
  const listen = { signal: off.signal, capture: true };
  element.addEventListener("pointerdown", down, listen);
  element.addEventListener("pointermove", move, listen);
  for (const end of ["pointerup", "pointercancel"] as const) element.addEventListener(end, give_up, listen);
  element.addEventListener("click", click, listen);
  element.addEventListener("contextmenu", (event) => event.preventDefault(), listen);
  return () => {
    give_up();
    off.abort();
  };
}
