// Keys, as the help on the page lists them.

import { isTyping } from "./dom.ts";

/** Lets keys act; names of keys are as events have them, letters small. */
export function initKeys(actions: Record<string, () => void>): void {
  window.addEventListener("keydown", (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target) || document.querySelector("dialog[open]")) return;
    const { target } = event;
    // These have keys of their own: buttons are pressed by space, sliders moved by arrows, radio buttons changed by them.
    if (target instanceof HTMLButtonElement && event.key === " ") return;
    if (target instanceof HTMLInputElement && /^(Arrow|Page|Home|End| )/.test(event.key) && target.id !== "error-slider") return;
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
