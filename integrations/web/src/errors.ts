/** What is wrong with an input, a file or a model; the message is written for users. */
export class MotionRTError extends Error {
  override name = "MotionRTError";
}

/** An argument cannot be used; the message says what is possible. */
export class InvalidInputError extends MotionRTError {
  override name = "InvalidInputError";
}

/** A file cannot be had, or does not hold what it should. */
export class LoadError extends MotionRTError {
  override name = "LoadError";
}

/** `value` if it is a number from `low` to `high`; InvalidInputError otherwise. */
export function checkedNumber(value: unknown, name: string, low: number, high: number): number {
  if (typeof value !== "number" || !(value >= low && value <= high))
    throw new InvalidInputError(`${name} must be a number from ${low} to ${high}, not ${String(value)}`);
  return value;
}

/** A text with something in it; InvalidInputError otherwise. */
export function checkedText(text: unknown): string {
  if (typeof text !== "string") throw new InvalidInputError(`a text must be a string, not ${typeof text}`);
  if (/[\ud800-\udbff](?![\udc00-\udfff])|(?<![\ud800-\udbff])[\udc00-\udfff]/.test(text))
    throw new InvalidInputError("the text holds half a character (a lone surrogate)");
  if (!text.trim()) throw new InvalidInputError("the text is empty; describe a motion, such as 'a person walks in a circle'");
  return text;
}
