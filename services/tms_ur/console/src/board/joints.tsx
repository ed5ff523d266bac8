// The joints of a machine, on request: a board is read from afar.
import { useTranslation } from "react-i18next";
import type { Joint } from "../models";

const degrees = (radians: number) => (radians * 180) / Math.PI;

export function Joints({ joints }: { joints: Joint[] }) {
  const { t } = useTranslation();
  if (joints.length === 0) {
    return null;
  }
  return (
    <details>
      <summary>{t("joint")}</summary>
      <table>
        <thead>
          <tr>
            <th scope="col">{t("joint")}</th>
            <th scope="col">{t("angle_rad")}</th>
            <th scope="col">{t("angle_deg")}</th>
          </tr>
        </thead>
        <tbody>
          {joints.map((joint) => (
            <tr key={joint.name}>
              <td>{joint.name}</td>
              <td>{joint.position.toFixed(3)}</td>
              <td>{degrees(joint.position).toFixed(1)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </details>
  );
}
