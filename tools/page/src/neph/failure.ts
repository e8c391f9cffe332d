// What can go wrong between a file and its picture, in words for the user of the page.

/** Something that stops a file from being shown: `message` is the headline, `advice` what to know or do. */
export class Failure extends Error {
  constructor(
    message: string,
    readonly advice: string,
  ) {
    super(message);
  }
}

export const notNeph = () =>
  new Failure("This is not a .neph file", "It does not begin as one. `nephrite build MESH -o FILE` makes one out of a mesh.");

export const cutShort = (found: number, expected: number) =>
  new Failure(
    "The file is cut short",
    `It has ${found.toLocaleString("en")} of ${expected.toLocaleString("en")} bytes. Copy or build it again.`,
  );

export const changed = () =>
  new Failure("The file has changed while it was viewed", "What is loaded belongs to the old one. Load the page again to see the new one.");

export const damaged = (what: string) =>
  new Failure("The file is damaged", `${what}. \`nephrite verify FILE\` says where else.`);

export const unreachable = (why: string) =>
  new Failure("The file cannot be read", `${why}. If \`nephrite view\` was stopped, start it again and load the page anew.`);

export const tooLarge = () =>
  new Failure("The file is too large for this browser", "It gives a page less memory than the file needs. `nephrite extract` cuts levels out of it.");

/** A failure as it is, anything else as an unforeseen one. */
export function asFailure(error: unknown): Failure {
  if (error instanceof Failure) return error;
  if (error instanceof RangeError) return tooLarge();
  return new Failure("Something went wrong", error instanceof Error ? error.message : String(error));
}
