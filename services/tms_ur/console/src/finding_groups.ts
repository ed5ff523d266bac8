// Findings of the same kind belong together: fifty leaves without a record are one thing to correct.
import type { Finding } from "./models";

interface Coded {
  code: string;
  args: Record<string, unknown>;
}

const isReason = (value: unknown): value is Coded => typeof value === "object" && value !== null && "code" in value;

/** The codes of a reason and of those inside it, without what they are about. */
function kindOf({ code, args }: Coded): string {
  const inner = Object.values(args).filter(isReason).map(kindOf);
  return inner.length > 0 ? `${code}(${inner.join()})` : code;
}

/** In the order in which each kind comes first. */
export const groupsOf = (found: Finding[]): Finding[][] => [
  ...Map.groupBy(found, (one) => kindOf(one.reason)).values(),
];
