// Whose log the address names: #system/PROCESS, #system/machine/NAME, #system/run/ID.
export const KINDS = ["process", "machine", "run"] as const;
export type Kind = (typeof KINDS)[number];

export interface Chosen {
  kind: Kind;
  name: string; // empty: none
}

/** `rest`: what stands behind `system/` in the address. A process has a colon in its name. */
export function chosenOf(rest: string): Chosen {
  const [first = "", second] = rest.split("/").map(decodeURIComponent);
  return second !== undefined && (first === "machine" || first === "run")
    ? { kind: first, name: second }
    : { kind: "process", name: first };
}

export function addressOf({ kind, name }: Chosen): string {
  const place = kind === "process" ? name : `${kind}/${encodeURIComponent(name)}`;
  return name === "" ? "#system" : `#system/${place}`;
}
