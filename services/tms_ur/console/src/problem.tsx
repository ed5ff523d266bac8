// Why something could not be read or done.
import type { ReasonView } from "./models";
import { Said } from "./said";

/** Errors of server.js carry the reason that the server gave; others have only a text. */
export function Problem({ id, error }: { id?: string; error: (Error & { reason?: ReasonView }) | null }) {
  return (
    <p id={id} className="bad" role="status">
      {error && <Said reason={error.reason} text={error.message} />}
    </p>
  );
}
