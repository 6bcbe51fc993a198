"use strict";
// Copy check values and code; a narrow window begins with the list of sections closed.
const said = document.getElementById("said");
function copied(text) {
  said.textContent = "Copied: " + (text.length > 40 ? text.slice(0, 40) + "…" : text);
  said.classList.add("shown");
  clearTimeout(copied.timer);
  copied.timer = setTimeout(() => said.classList.remove("shown"), 1500);
}
function copyByHand(text) {
  const field = document.createElement("textarea");
  field.value = text;
  document.body.append(field);
  field.select();
  document.execCommand("copy");
  field.remove();
}
async function copy(event) {
  const button = event.target.closest(".value, .copy");
  if (!button) return;
  event.preventDefault();
  const text = button.dataset.copy ?? button.nextElementSibling.textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    copyByHand(text);
  }
  button.focus();
  copied(text);
}
document.addEventListener("click", copy);
document.addEventListener("keydown", (event) => {
  const pressed = event.key === "Enter" || event.key === " ";
  if (pressed && event.target.matches(".value")) copy(event);
});
const sections = document.querySelector("nav details");
if (sections && matchMedia("(max-width: 71.99rem)").matches) sections.open = false;
