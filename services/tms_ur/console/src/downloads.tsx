// Links that save files.
import { useTranslation } from "react-i18next";

interface Props {
  id: string;
  label: string; // key: what they are files of
  files: readonly (readonly [name: string, href: string])[];
}

export function Downloads({ id, label, files }: Props) {
  const { t } = useTranslation();
  return (
    <div id={id} className="bar">
      <span>{t(label)}:</span>
      {files.map(([name, href]) => (
        <a key={name} className="button" href={href} download="" aria-label={`${t(label)}: ${name}`}>
          {name}
        </a>
      ))}
    </div>
  );
}
