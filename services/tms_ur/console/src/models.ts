// Names for what the API sends, by the models of its document.
import type { components } from "./api";

type Models = components["schemas"];
export type ActiveRun = Models["ActiveRun"];
export type Alarm = Models["Alarm"];
export type AreasChecked = Models["AreasChecked"];
export type Checked = Models["Checked"];
export type EnabledAreas = Models["EnabledAreas"];
export type Event = Models["Event"];
export type FieldGiven = Models["FieldGiven"];
export type Finding = Models["Finding"];
export type Ground = Models["Ground"];
export type Joint = Models["Joint"];
export type Logs = Models["Logs"];
export type Machine = Models["Machine"];
export type Process = Models["Process"];
export type Question = Models["Question"];
export type ReasonView = Models["ReasonView"];
export type RecordChange = Models["Change"];
export type Recording = Models["Recording"];
export type ResumePlan = Models["ResumePlan"];
export type Run = Models["Run"];
export type SeenBy = Models["SeenBy"];
export type SensingInput = Models["SensingInput"];
export type Series = Models["Series"];
export type Session = Models["Session"];
export type SharedPlace = Models["SharedPlace"];
export type SharedPlaces = Models["SharedPlaces"];
export type SiteMachine = Models["SiteMachine"];
export type State = Models["State"];
export type Stored = Models["Record"]; // a record; TypeScript has that name
export type Task = Models["Task"];
export type Template = Models["Template"];
export type Tree = Models["Tree"];
export type Work = Models["Work"];
export type WorkSum = Models["WorkSum"];
