// The knobs of the line: label, box with unit, slider, a tick where it was before, and what a step of it does.

const NOTCHES = 400;
/** How long a thumb rests until its value counts [ms]. */
const REST = 150;
const GROUPS = [["running", "While the line runs"], ["stopped", "While the line is stopped"], ["rebuilt", "Fixed by the design"]];

const capital = (text) => text[0].toUpperCase() + text.slice(1);

/** A number with so many significant digits, and a minus sign as long as a plus. */
const plain = (value, digits) => String(Number(value.toPrecision(digits))).replace("-", "−");

/** The decimals that an error allows: one digit, two if the first is 1; at most so many. */
function decimals(error, most) {
  const more = error.toExponential().startsWith("1") ? 1 : 0;
  return Math.max(0, Math.min(most, more - Math.floor(Math.log10(error))));
}

/** A relative change in per cent, `+5 ± 2 %`. */
function changed({ change, standard_error: error }) {
  const [value, by] = [100 * change, 100 * error];
  const places = error > 0 ? decimals(by, 1) : 1;
  const sign = value > 0 ? "+" : value < 0 ? "−" : "";
  const text = `${sign}${Math.abs(value).toFixed(places)}${error > 0 ? ` ± ${by.toFixed(places)}` : ""} %`;
  return text.replaceAll(" ", "\u00a0");
}

/** The step of which the effect is known, `+20 %` or `+10 K`, or the same step the other way. */
function stepText({ words }, sign = 1) {
  const isDown = /^[-−]/.test(words) !== sign < 0;
  return `${isDown ? "−" : "+"}${words.slice(1)}`;
}

/** How many such steps lead from one value to another. Temperatures have steps in kelvin. */
function stepsTo({ words, step }, from, to) {
  if (words.endsWith("K")) return (to - from) / parseFloat(words.replace("−", "-"));
  return from > 0 && to > 0 ? Math.log(to / from) / Math.log(1 + step) : 0;
}

class Knobs {
  /**
   * `set(name, value)` is called when a knob is turned; it returns the stamp that the answer will have.
   * `moves(name, value)` is called while a slider moves, and without arguments if its value will not be sent.
   */
  constructor(form, place, set, moves) {
    Object.assign(this, { form, place, set, moves, all: new Map(), held: null });
    form.addEventListener("submit", (e) => e.preventDefault());
    for (const end of ["pointerup", "pointercancel", "blur"]) addEventListener(end, () => this.release());
  }

  /** Takes the knobs with their values; returns those that have moved although this page did not turn them. */
  take(knobs) {
    const stays = knobs.length === this.all.size && knobs.every(({ name }) => this.all.has(name));
    if (!stays) this.build(knobs);
    const moved = [];
    for (const knob of knobs) {
      const control = this.all.get(knob.name);
      if (stays && knob.value !== control.knob.value && knob.value !== control.asked) moved.push(knob);
      control.knob = knob;
      // What is being turned, or has been refused, is left alone.
      if (control === this.held || control.timer || control.stamp) control.isLate = true;
      else if (control.wrong.hidden) this.show(control);
    }
    return moved;
  }

  build(knobs) {
    this.all.clear();
    this.place.replaceChildren(
      ...GROUPS.map(([turned, title]) => {
        const group = element("fieldset");
        const own = knobs.filter((knob) => knob.turned === turned);
        group.append(element("legend", { textContent: title }), ...own.map((knob) => this.make(knob)));
        group.hidden = group.children.length === 1;
        return group;
      }),
    );
  }

  make(knob) {
    const row = element("div", { className: "knob" });
    row.dataset.knob = knob.name;
    const id = `knob-${knob.name.replaceAll(".", "-")}`;
    const text = element("input", { id, autocomplete: "off" });
    const slider = element("input", { type: "range", min: 0, max: NOTCHES, step: 1 });
    slider.setAttribute("aria-label", knob.label);
    const tick = element("i");
    const [effect, was] = [element("span"), element("span")];
    const wrong = element("p", { className: "wrong", id: `${id}-wrong`, hidden: true });
    wrong.setAttribute("role", "alert");
    const control = { knob, row, text, slider, tick, effect, was, wrong };
    const [top, track, under] = ["top", "track", "under"].map((className) => element("div", { className }));
    const label = element("label", { htmlFor: id, textContent: capital(knob.label), title: knob.key });
    top.append(label, text);
    track.append(slider, tick);
    under.append(effect, was);
    row.append(top, track, under, wrong);

    slider.addEventListener("pointerdown", () => (this.held = control));
    slider.addEventListener("input", () => {
      control.turnedTo = this.valueAt(control.knob, Number(slider.value));
      this.accept(control);
      this.preview(control);
      clearTimeout(control.timer);
      control.timer = setTimeout(() => this.send(control), REST);
    });
    text.addEventListener("change", () => {
      // A bare number is one in the unit of the knob.
      const written = text.value.trim().replace("−", "-");
      control.isEdited = false;
      if (written !== "") this.ask(control, Number.isNaN(Number(written)) ? written : Number(written));
      else this.show(control);
    });
    text.addEventListener("input", () => {
      control.isEdited = true;
      this.accept(control);
    });
    text.addEventListener("blur", () => (control.isEdited = false));
    this.all.set(knob.name, control);
    this.show(control);
    return row;
  }

  /** Whether the slider has a logarithmic scale: over a factor of three and more. */
  isLogarithmic({ from, to }) {
    return from > 0 && to / from >= 3;
  }

  rounded({ from, to, digits, is_whole: isWhole }, value) {
    const bounded = Math.min(to, Math.max(from, value));
    return isWhole ? Math.round(bounded) : Number(bounded.toPrecision(digits));
  }

  valueAt(knob, notch) {
    const { from, to } = knob;
    const share = notch / NOTCHES;
    return this.rounded(knob, this.isLogarithmic(knob) ? from * (to / from) ** share : from + share * (to - from));
  }

  /** Where a value lies on the slider, from 0 to 1. */
  shareOf(knob, value) {
    const { from, to } = knob;
    const isLogarithmic = this.isLogarithmic(knob);
    const share = isLogarithmic ? Math.log(value / from) / Math.log(to / from) : (value - from) / (to - from);
    return Math.min(1, Math.max(0, share));
  }

  written({ unit, digits, is_whole: isWhole }, value) {
    return `${isWhole ? value.toFixed(0) : plain(value, digits)}${unit ? ` ${unit}` : ""}`;
  }

  /** Shows what the program says of a knob. */
  show(control) {
    const { knob, row, text, slider, tick, effect, was } = control;
    control.turnedTo = control.asked = null;
    control.isLate = false;
    control.shown = this.written(knob, knob.value);
    if (!control.isEdited) text.value = control.shown;
    // A slider whose notch rounds to this value stays there, or it would stick under the arrow keys.
    const isThere = this.valueAt(knob, Number(slider.value)) === knob.value;
    if (!isThere) slider.value = Math.round(NOTCHES * this.shareOf(knob, knob.value));
    slider.setAttribute("aria-valuetext", control.shown);
    // The middle of a thumb of 16 px does not reach the ends of its track.
    tick.style.left = `calc(8px + ${this.shareOf(knob, knob.was)} * (100% - 16px))`;
    const moved = Math.abs(knob.value - knob.was) > 1e-9 * Math.abs(knob.was);
    row.classList.toggle("moved", moved);
    was.textContent = moved ? `before ${this.written(knob, knob.was)}` : "";
    effect.textContent = knob.effect ? `${stepText(knob.effect)}: CV ${changed(knob.effect)}` : "";
  }

  /** The step with the largest significant effect on the CV; knobs that can be turned today come first. */
  first() {
    const isSure = ({ change, standard_error: error }) => Math.abs(change) > 2 * error;
    const known = [...this.all.values()].filter(({ knob }) => knob.effect && isSure(knob.effect));
    const today = known.filter(({ knob }) => knob.turned === "running");
    const of = today.length > 0 ? today : known;
    return of.sort((a, b) => Math.abs(b.knob.effect.change) - Math.abs(a.knob.effect.change))[0] ?? null;
  }

  /** Turns a knob by the step of which the effect is known, up or down, so that the CV falls. */
  turnFirst() {
    const control = this.first();
    const { value, effect } = control.knob;
    const sign = -Math.sign(effect.change);
    const kelvin = effect.words.endsWith("K") ? parseFloat(effect.words.replace("−", "-")) : null;
    control.turnedTo = this.rounded(control.knob, kelvin ? value + sign * kelvin : value * (1 + sign * effect.step));
    this.send(control);
  }

  /** While a thumb moves: its value, and what the known effect of a step lets expect. */
  preview(control) {
    const { knob, text, slider, was, turnedTo } = control;
    this.moves(knob.name, turnedTo);
    text.value = this.written(knob, turnedTo);
    slider.setAttribute("aria-valuetext", text.value);
    const { effect } = knob;
    const steps = effect ? stepsTo(effect, knob.value, turnedTo) : 0;
    was.textContent = steps ? `about ${changed({ change: (1 + effect.change) ** steps - 1 })}` : "";
  }

  send(control) {
    clearTimeout(control.timer);
    control.timer = null;
    const { turnedTo, asked, knob } = control;
    if (turnedTo !== null && turnedTo !== (asked ?? knob.value)) return this.ask(control, turnedTo);
    this.moves();
    if (control !== this.held && !control.stamp) this.show(control);
  }

  ask(control, value) {
    this.accept(control);
    control.isEdited = false;
    control.asked = value;
    control.stamp = this.set(control.knob.name, value);
  }

  /** The thumb is let go: its value counts at once. */
  release() {
    const control = this.held;
    this.held = null;
    if (!control) return;
    if (control.timer) this.send(control);
    else if (control.isLate && !control.stamp && control.wrong.hidden) this.show(control);
  }

  of(stamp) {
    return [...this.all.values()].find((control) => control.stamp === stamp);
  }

  applied(stamp) {
    const control = this.of(stamp);
    if (!control) return;
    control.stamp = null;
    this.accept(control);
    const isThere = control.isLate || control.asked === control.knob.value;
    if (isThere && control !== this.held && !control.timer) this.show(control);
  }

  /** Marks a value that is not possible, with the reason below it. Box and slider keep it. */
  refuse(stamp, why) {
    const control = this.of(stamp);
    if (!control) return false;
    control.stamp = null;
    this.moves();
    control.text.value = typeof control.asked === "number" ? this.written(control.knob, control.asked) : control.asked;
    control.asked = null;
    control.wrong.textContent = `${why.replace(/\.$/, "")}. The simulation continues with the previous line; Escape restores it.`;
    control.wrong.hidden = false;
    control.was.textContent = "";
    control.text.setAttribute("aria-invalid", "true");
    control.text.setAttribute("aria-describedby", control.wrong.id);
    control.wrong.scrollIntoView({ block: "nearest" });
    return true;
  }

  accept(control) {
    control.wrong.hidden = true;
    control.text.removeAttribute("aria-invalid");
    control.text.removeAttribute("aria-describedby");
  }

  /** Takes back what is being turned, written or was refused; returns whether there was any. */
  takeBack() {
    const open = [...this.all.values()].filter((c) => c.timer || c === this.held || !c.wrong.hidden || c.isEdited);
    this.moves();
    for (const control of open) {
      clearTimeout(control.timer);
      control.timer = null;
      this.accept(control);
      control.isEdited = false;
      this.show(control);
    }
    return open.length > 0;
  }

  /** Whether a box has text that nobody has asked for yet. */
  isEdited(box) {
    return [...this.all.values()].some((control) => control.text === box && control.isEdited);
  }

  /** The connection is gone: what was asked will not be answered. */
  forget() {
    for (const control of this.all.values()) control.stamp = control.asked = null;
  }
}
