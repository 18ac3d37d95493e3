// Dark or light, as the reader's machine is set until the button says otherwise.

const button = document.getElementById("theme");
const paint = (theme) => {
  document.documentElement.dataset.theme = theme;
  button.setAttribute("aria-pressed", theme === "dark");
};
button.addEventListener("click", () => paint(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
paint(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
