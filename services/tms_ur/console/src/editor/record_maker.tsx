// A new record for a field of a node: by its fields, or by a place that is clicked on the map.
import { lazy, Suspense, useState } from "react";
import { useTranslation } from "react-i18next";
import { NewRecord } from "../data/new_record";
import type { Stored } from "../models";
import { may } from "../role";

const PickPlace = lazy(() => import("../map/pick_place"));

interface Props {
  machine: string; // whose record it is to be
  records: Stored[];
  onMade: (record: string) => void; // its name, without the machine's
}

export function RecordMaker({ machine, records, onMade }: Props) {
  const { t } = useTranslation();
  const [way, setWay] = useState<"fields" | "place" | null>(null);
  if (!may("admin")) {
    return null; // a record is an admin's
  }
  const close = () => setWay(null);
  const made = (name: string) => {
    close();
    onMade(name.slice(name.indexOf("/") + 1));
  };
  return (
    <>
      <div className="bar">
        <button type="button" aria-expanded={way === "fields"} onClick={() => setWay("fields")}>
          {t("new_record")}
        </button>
        {machine !== "" && (
          <button type="button" aria-expanded={way === "place"} onClick={() => setWay("place")}>
            {t("ed_from_map")}
          </button>
        )}
      </div>
      {way === "fields" && <NewRecord machine={machine} records={records} onSaved={made} onClose={close} />}
      {way === "place" && (
        <Suspense>
          <PickPlace machine={machine} onSaved={made} onClose={close} />
        </Suspense>
      )}
    </>
  );
}
