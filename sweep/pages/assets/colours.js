// Maps of colours that rise evenly in lightness and are told apart by the colour-blind.

const STEPS = 64;
const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];
const CIVIDIS = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
const MAPS = { speed: ramp(VIRIDIS), force: ramp(CIVIDIS) };

function ramp(anchors) {
  const stops = anchors.map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  return Array.from({ length: STEPS }, (_, k) => {
    const place = (k / (STEPS - 1)) * (stops.length - 1);
    const low = Math.min(Math.floor(place), stops.length - 2);
    const mixed = stops[low].map((part, c) => Math.round(part + (place - low) * (stops[low + 1][c] - part)));
    return `rgb(${mixed.join(",")})`;
  });
}

function colourOf(map, share) {
  return map[Math.max(0, Math.min(STEPS - 1, Math.floor(share * STEPS)))];
}

// A colour of the page's style, such as "--ink".
function styled(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
