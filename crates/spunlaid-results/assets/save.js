// Saving figures and copying texts out of a report.

function download(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The buttons that save a figure. */
function startSaving() {
  const text = (svg) => new XMLSerializer().serializeToString(svg);
  const savePng = (svg, name) => {
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [3 * svg.width.baseVal.value, 3 * svg.height.baseVal.value];
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => download(`${name}.png`, blob));
    };
    image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text(svg))}`;
  };
  document.querySelectorAll("figure.chart").forEach((figure) => {
    const [svg, name] = [figure.querySelector("svg"), figure.dataset.name];
    figure.querySelectorAll("[data-save]").forEach((button) =>
      button.addEventListener("click", () => {
        if (button.dataset.save === "png") savePng(svg, name);
        else download(`${name}.svg`, new Blob([text(svg)], { type: "image/svg+xml" }));
      }),
    );
  });
}

/** The buttons that copy a text of the page: the case, the methods. */
function startCopying() {
  document.querySelectorAll("[data-copy]").forEach((button) =>
    button.addEventListener("click", async () => {
      const block = document.getElementById(button.dataset.copy);
      let done = true;
      try {
        await navigator.clipboard.writeText(block.innerText);
      } catch {
        // Without leave to write the clipboard: mark the text, for the reader's own copy key.
        getSelection().selectAllChildren(block);
        done = false;
      }
      button.textContent = done ? "Copied" : "Marked: press Ctrl+C";
      setTimeout(() => (button.textContent = "Copy"), 2500);
    }),
  );
}

startSaving();
startCopying();
