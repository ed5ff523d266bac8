import { sayError } from "old/reasons.js";
import type { FormEvent } from "react";
import { useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import { post } from "./server";

export function Login() {
  const { t } = useTranslation();
  const name = useRef<HTMLInputElement>(null);
  const password = useRef<HTMLInputElement>(null);
  useEffect(() => name.current?.focus(), []);
  const enter = async (event: FormEvent) => {
    event.preventDefault();
    try {
      await post("/api/login", { name: name.current?.value ?? "", password: password.current?.value ?? "" });
      const panel = Number(new URLSearchParams(location.search).get("panel")); // a panel sent the browser here
      if (panel) {
        location.href = `/panel.html?task=${panel}`;
      } else {
        location.reload();
      }
    } catch (error) {
      if (password.current !== null) {
        password.current.value = "";
      }
      sayError(error);
    }
  };
  return (
    <form id="login" onSubmit={enter}>
      <h2>{t("login")}</h2>
      <label>
        <span>{t("name")}</span>
        <input id="login_name" ref={name} autoComplete="username" required maxLength={64} />
      </label>
      <label>
        <span>{t("password")}</span>
        <input
          id="login_password"
          ref={password}
          type="password"
          autoComplete="current-password"
          required
          maxLength={200}
        />
      </label>
      <button type="submit" className="go">
        {t("login")}
      </button>
    </form>
  );
}
