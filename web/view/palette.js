/** Colours of what is drawn on canvases; the same as in style/tokens.css. */
export const ACCENT = "#5fd0ff";
export const GUESS = "#ffc857";
export const PATH = "#6fe0a1";
export const INK = "#f2f5f7";
export const SOFT = "rgb(242 245 247 / 55%)";
export const FAINT = "rgb(242 245 247 / 16%)";
export const SHADE = "rgb(8 11 14 / 78%)";
export const FONT = '"Inter", system-ui, sans-serif';
