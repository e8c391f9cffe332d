// What cannot be shown, said on the page: in its middle while there is no picture, above it once there is one.

import type { Failure } from "../neph/failure.ts";
import { button, element } from "./dom.ts";

/** Says what went wrong; `hasPicture` leaves what is already seen in sight. */
export function showFailure(failure: Failure, hasPicture: boolean): void {
  const message = element("message");
  message.classList.toggle("banner", hasPicture);
  element("message-title").textContent = failure.message;
  // What stands in backticks is typed somewhere.
  const parts = failure.advice.split("`").map((text, index) => {
    const part = document.createElement(index % 2 === 1 ? "code" : "span");
    part.textContent = text;
    return part;
  });
  element("message-advice").replaceChildren(...parts);
  message.hidden = false;
  document.documentElement.dataset.phase = "failed";
}

export function hideFailure(): void {
  element("message").hidden = true;
}

export function initMessage(): void {
  button("message-reload").addEventListener("click", () => location.reload());
}
