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

/** The buttons that copy a text of the page (the case, the methods) or a command. */
function startCopying() {
  document.querySelectorAll("[data-copy], [data-command]").forEach((button) =>
    button.addEventListener("click", async () => {
      const { copy, command } = button.dataset;
      const block = document.getElementById(copy) ?? button;
      let said = "Copied";
      try {
        await navigator.clipboard.writeText(command ?? block.innerText);
      } catch {
        // Without leave to write the clipboard: show the text, for the reader's own copy key.
        if (command) prompt("Ctrl+C copies it", command);
        else getSelection().selectAllChildren(block);
        said = command ? "Copy" : "Selected: press Ctrl+C";
      }
      button.textContent = said;
      setTimeout(() => (button.textContent = "Copy"), 2500);
    }),
  );
}

// Paper cannot be unfolded.
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((all) => (all.open = true)));
startSaving();
startCopying();
