import { App } from "./app";
import { byId, make } from "./panel/dom";

try {
  new App().start();
} catch (error) {
  // Without WebGL there is no picture, and no page worth having: that is said where the picture would be.
  const why = error instanceof Error ? error.message : String(error);
  byId("troubles", HTMLDivElement).append(
    make("p", {
      className: "trouble error",
      textContent: `The page cannot draw here: ${why}. It needs a browser with WebGL 2 switched on.`,
    }),
  );
}
