// A button that gives a command once: it is disabled until the answer comes, and only shown to whom the server obeys.

import { say } from "old/dom.js";
import { sayError } from "old/reasons.js";
import { type ReactNode, useRef, useState } from "react";
import { may, type Role } from "./role";

interface Props {
  work: () => Promise<string>; // resolves to the text to show
  children: ReactNode;
  className?: string;
  label?: string; // spoken name, where it tells more than the text
  id?: string;
  disabled?: boolean;
  needs?: Role; // that the server asks for
}

export function Command({ work, children, className, label, id, disabled = false, needs = "operator" }: Props) {
  const [busy, setBusy] = useState(false);
  const element = useRef<HTMLButtonElement>(null);
  const give = async () => {
    setBusy(true);
    say("");
    try {
      const text = await work();
      if (text !== "") {
        say(text);
      }
    } catch (error) {
      sayError(error);
    } finally {
      setBusy(false);
      if (document.activeElement === document.body) {
        requestAnimationFrame(() => element.current?.focus()); // the disabled button has lost the focus
      }
    }
  };
  if (!may(needs)) {
    return null;
  }
  return (
    <button
      type="button"
      id={id}
      ref={element}
      className={className}
      disabled={busy || disabled}
      aria-label={label}
      onClick={give}
    >
      {children}
    </button>
  );
}
