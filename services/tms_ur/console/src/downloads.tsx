// Links that save the same thing as files of several forms.
import { useTranslation } from "react-i18next";

interface Props {
  id: string;
  label: string; // key
  forms: string[];
  href: (form: string) => string;
}

export function Downloads({ id, label, forms, href }: Props) {
  const { t } = useTranslation();
  return (
    <div id={id} className="bar">
      <span>{t(label)}:</span>
      {forms.map((form) => (
        <a
          key={form}
          className="button"
          href={href(form)}
          download=""
          aria-label={`${t(label)}: ${form.toUpperCase()}`}
        >
          {form.toUpperCase()}
        </a>
      ))}
    </div>
  );
}
