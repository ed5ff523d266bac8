// Map: machines, areas, people, paths and records of the site, and the arms from the side.

import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { Downloads } from "../downloads";
import { useLive } from "../live";
import { Problem } from "../problem";
import { get } from "../server";
import { useList } from "../use_list";
import { Notes } from "./notes";
import { SideView } from "./side_view";
import { SiteMap } from "./site_map";

const readSite = () => get("/api/site");

export default function MapPage({ rest }: { rest: string }) {
  const { t } = useTranslation();
  const { state } = useLive();
  const { list: site, error } = useList(readSite);
  const bodies = useMemo(() => new Map(site?.machines.map((one) => [one.name, one])), [site]);
  const inSpace = rest === "3d";
  return (
    <>
      <h2>{t("p_map")}</h2>
      <Problem id="site_problem" error={error} />
      {state && <Notes state={state} />}
      {state && site && <SiteMap state={state} bodies={bodies} inSpace={inSpace} />}
      {!inSpace && (
        <div id="arms" className="cards">
          {state?.machines.map((machine) => {
            const body = bodies.get(machine.name);
            return body && machine.joints.length > 0 ? (
              <SideView key={machine.name} machine={machine} body={body} />
            ) : null;
          })}
        </div>
      )}
      {site && (
        <Downloads
          id="urdf"
          label="urdf"
          files={site.machines.map(({ name }) => [name, `/api/machines/${name}/urdf`])}
        />
      )}
    </>
  );
}
