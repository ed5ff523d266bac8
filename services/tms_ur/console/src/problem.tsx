// Why something could not be read or done.
import type { ReasonView } from "./models";
import { Said } from "./said";

interface Props {
  id?: string;
  what?: string; // is missing: told first
  error: (Error & { reason?: ReasonView }) | null;
}

/** Errors of server.js carry the reason that the server gave; others have only a text. */
export function Problem({ id, what, error }: Props) {
  return (
    <p id={id} className="bad" role="status">
      {error && <Said reason={error.reason} text={what ? `${what}: ${error.message}` : error.message} />}
    </p>
  );
}
