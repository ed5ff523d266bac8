// What other processes tell in English words of their own, as an operator says it. Texts that are not known stay as they are.
import { t } from "./strings.js";

const KNOWN = [
  [/^software stop by (.+) at (.+)$/, "told_stop_by"],
  [/^software stop$/, "told_stop"],
  [/^given up by an operator after an interruption$/, "told_given_up"],
  [/^(\w+) was (?:stopped|told to stop): (.+)$/, "told_was_stopped"],
  [/^(\w+) is being stopped$/, "told_being_stopped"],
  [/^(\w+) is in run (\S+?)(?:: .*)?$/, "told_busy"],
  [/^(\w+) is (?:stopped|latched) \((.+)\)(?:: re-arm.*)?$/, "told_latched"],
  [/^(\w+) is not ready: (.+)$/, "told_not_ready"],
  [/^no note on this PC says how the machine was left: .*$/, "told_no_note"],
  [/^STALLED: (\w+) stands at (\S+) rad, it should have passed (\S+) rad$/, "told_stalled"],
  [/^OFF_PATH: (\w+) is at (\S+) rad, .*$/, "told_off_path"],
  [/^it left stand-still without a goal of its own$/, "told_left"],
  [/^after its start the gateway still proves that the machine stands$/, "told_proves"],
  [/^(.+) drives (\w+) by hand$/, "told_driven"],
  [/^sending$/, "told_sending"],
  [/^PLANNING$/, "told_planning"],
  [/^MOVING (\d+)\/(\d+) (\d+) %(.*)$/, "told_moving"],
  [/^DRIVING (\S+) m to go(.*)$/, "told_driving"],
  [/^TURNING (\S+) rad to go(.*)$/, "told_turning"],
  [/^waits (\S+) s$/, "told_waits"],
  [/^waits for an operator: (.*)$/, "told_asks"],
  [/^(.+); sent again when the process is back.*$/, "told_again"],
  [/^line (\d+)(?:, at [^:]+)?: no record (\S+); did you mean '(.+)'\?.*$/, "told_record_near"],
  [/^line (\d+)(?:, at [^:]+)?: no record (\S+); add it.*$/, "told_record"],
  [/^line (\d+)(?:, at [^:]+)?: there is no node '(.+?)' \(did you mean '(.+)'\?\)$/, "told_node_near"],
  [/^line (\d+)(?:, at [^:]+)?: there is no node '(.+?)'(.*)$/, "told_node"],
  [/^line (\d+)(?:, at [^:]+)?: (\w+) offers no '(.+?)'(.*)$/, "told_subtask"],
  [/^line (\d+)(?:, at [^:]+)?: the site has no machine '(.+?)'(.*)$/, "told_machine"],
  [/^line (\d+): record (\S+) does not fit \w+: (\w+): \S+ rad is (?:above|below) its limit (\S+) rad;.*$/, "told_limit"],
  [/^line (\d+)(?:, at [^:]+)?: (.+)$/, "told_line"],
];

/** A reason, a cause or a finding in the language of the page. */
export function told(text) {
  for (const [pattern, key] of KNOWN) {
    const found = pattern.exec(text);
    if (found !== null) {
      return t(key, { a: found[1], b: part(found[2]), c: found[3], d: found[4] });
    }
  }
  return text;
}

// A cause within a sentence.
const part = (text) => (text === undefined ? "" : told(text));
