// The data of a page, and elements made of text, which is never markup.

// Letters that are not seen, or that turn the direction of others, are shown as what cannot be shown.
const UNSEEN = /[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff\u{e0000}-\u{e007f}]/gu;

const data = JSON.parse(document.getElementById("data").textContent, (_, value) =>
  typeof value === "string" ? value.replace(UNSEEN, "\ufffd") : value);

function el(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(key, value);
    else if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}
