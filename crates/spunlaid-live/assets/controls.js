// The sliders and choices, made from the table of keys.

const NOTCHES = 1000;
/** Largest part of a value by which three digits round it. */
const ROUNDED = 5.1e-3;

/** A label of the table of keys: `*italics*`, `_{subscripts}`. */
function labelled(place, label) {
  for (const part of label.split(/(\*[^*]+\*|_\{[^}]+\})/)) {
    if (!part) continue;
    const tag = part.startsWith("*") ? "i" : part.startsWith("_{") ? "sub" : null;
    if (!tag) {
      place.append(part);
      continue;
    }
    place.append(element(tag, { textContent: tag === "i" ? part.slice(1, -1) : part.slice(2, -1) }));
  }
}

const TITLES = { spinline: "Spinline", fibre: "Fibre", feed: "Feed", belt: "Belt", air: "Air", drag: "Drag", run: "Computation" };

class Controls {
  /**
   * `set(key, value, written)` is called when something is changed, and returns the stamp of its answer; `written` is
   * whether it was written into a box.
   */
  constructor(form, set) {
    Object.assign(this, { form, set, controls: new Map() });
    form.addEventListener("submit", (e) => e.preventDefault());
  }

  /** Makes the controls for these settings, those to look at first on top. Those that are there stay, with their new ranges. */
  build(settings) {
    const stays = (s) => this.controls.get(s.key)?.setting.takes === s.takes;
    if (settings.length === this.controls.size && settings.every(stays)) {
      settings.forEach((s) => (this.controls.get(s.key).setting = s));
      return;
    }
    this.controls.clear();
    this.form.replaceChildren();
    this.group(this.form, "Main settings", settings.filter((s) => s.first));
    const rest = settings.filter((s) => !s.first);
    for (const table of new Set(rest.map((s) => s.table))) {
      const more = element("details");
      more.append(element("summary", { textContent: `More: ${TITLES[table].toLowerCase()}` }));
      this.group(more, TITLES[table], rest.filter((s) => s.table === table));
      this.form.append(more);
    }
  }

  group(place, title, settings) {
    const set = element("fieldset");
    set.append(element("legend", { textContent: title }), ...settings.map((s) => this.control(s)));
    place.append(set);
  }

  control(setting) {
    const row = element("div", { className: "setting" });
    const id = `key-${setting.key.replace(".", "-")}`;
    const about = element("details");
    const name = element("summary", { id: `${id}-name`, title: `${setting.meaning} ${setting.about}` });
    labelled(name, setting.label === setting.key ? this.plain(setting.key) : setting.label);
    const effect = setting.in_flight ? "It changes at once." : "The fibres start again with it.";
    about.append(name, element("p", { textContent: `${setting.meaning.replace(/`/g, "")} ${setting.about} ${effect}` }));
    const head = element("div", { className: "head" });
    row.append(head);
    const control = { setting };
    const text = element(setting.takes === "word" ? "select" : "input");
    text.setAttribute("aria-labelledby", name.id);
    text.dataset.key = setting.key;
    if (setting.takes === "word") setting.words.forEach((word) => text.add(new Option(word)));
    else text.autocomplete = "off";
    text.addEventListener("change", () => this.set(setting.key, text.value, true));
    text.addEventListener("input", () => this.accept(setting.key));
    text.addEventListener("keydown", (e) => {
      if (e.key !== "Escape" || !control.now) return;
      this.accept(setting.key);
      text.value = control.now;
    });
    head.append(about, text);
    control.text = text;
    control.wrong = element("p", { className: "wrong", id: `${id}-wrong`, hidden: true });
    control.wrong.setAttribute("role", "alert");
    row.append(control.wrong);
    if (setting.takes === "quantity") {
      const slider = element("input", { type: "range", min: 0, max: NOTCHES, step: 1, id });
      slider.setAttribute("aria-labelledby", name.id);
      slider.dataset.key = setting.key;
      slider.addEventListener("input", () => {
        control.stamp = this.set(setting.key, this.value(control.setting, Number(slider.value)));
      });
      row.append(slider);
      control.slider = slider;
    }
    this.controls.set(setting.key, control);
    return row;
  }

  /** A key without a label: `run.seed` → `Seed`. */
  plain(key) {
    const name = key.split(".")[1].replaceAll("_", " ");
    return name[0].toUpperCase() + name.slice(1);
  }

  /** The value at a notch in SI units; the program rounds it in the unit in which it is shown. */
  value({ low, high, logarithmic }, notch) {
    const share = notch / NOTCHES;
    return logarithmic ? low * (high / low) ** share : low + share * (high - low);
  }

  notch({ low, high, logarithmic }, value) {
    const share = logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return Math.round(NOTCHES * share);
  }

  /** Shows the present values, but leaves alone what is being changed. */
  show(values) {
    for (const { key, si, text } of values) {
      const control = this.controls.get(key);
      if (!control) continue;
      control.now = text;
      // What is wrong stays to be mended.
      if (control.wrong.hidden && (control.text !== document.activeElement || control.setting.takes === "word")) control.text.value = text;
      if (!control.slider) continue;
      control.slider.setAttribute("aria-valuetext", text);
      // The program rounds to three digits. A slider that went back by that would stick under the arrow keys.
      const isThere = Math.abs(this.value(control.setting, Number(control.slider.value)) - si) <= ROUNDED * Math.abs(si);
      // What arrives before the answer to its last change is about an earlier one.
      if (control.slider !== this.held && !control.stamp && !isThere) control.slider.value = this.notch(control.setting, si);
    }
  }

  /** The program has answered a change, or with no stamp, it will answer none of them. */
  answered(stamp) {
    for (const control of this.controls.values()) if (!stamp || control.stamp === stamp) control.stamp = null;
  }

  /** Marks a value that was written and cannot be simulated, and says why beside it. The box keeps it. */
  refuse(key, value, why) {
    const { text, wrong } = this.controls.get(key);
    [text.value, wrong.textContent, wrong.hidden] = [value, `${why}. The simulation continues with the previous value; Escape restores it.`, false];
    text.setAttribute("aria-invalid", "true");
    text.setAttribute("aria-describedby", wrong.id);
  }

  accept(key) {
    const control = this.controls.get(key);
    if (!control || control.wrong.hidden) return;
    control.wrong.hidden = true;
    control.text.removeAttribute("aria-invalid");
    control.text.removeAttribute("aria-describedby");
  }

  /** Remembers the slider under a pointer: it is not moved by what the program says. `released` is called when it is let go. */
  watch(released) {
    this.form.addEventListener("pointerdown", (e) => (this.held = e.target.type === "range" ? e.target : null));
    addEventListener("pointerup", () => {
      this.held = null;
      released();
    });
  }
}
