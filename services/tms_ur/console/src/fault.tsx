// A page that cannot be shown takes nothing else with it: without this the whole console would go, and its stop button.
import { Component, type ReactNode } from "react";
import { useTranslation } from "react-i18next";

interface State {
  failed: boolean;
}

/** Give it the page as its key, so that another page begins anew. */
export class Fault extends Component<{ children: ReactNode }, State> {
  override state: State = { failed: false };

  static getDerivedStateFromError(): State {
    return { failed: true };
  }

  override render() {
    return this.state.failed ? <Failed /> : this.props.children;
  }
}

/** Mostly its code has not come, since the server was away, or has another release by now. */
function Failed() {
  const { t } = useTranslation();
  return (
    <div role="alert">
      <p className="bad">{t("page_failed")}</p>
      <button type="button" onClick={() => location.reload()}>
        {t("page_again")}
      </button>
    </div>
  );
}
