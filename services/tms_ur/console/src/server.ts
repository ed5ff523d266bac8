// Calls of the API with the types of its OpenAPI document.
import { ask } from "old/server.js";
import type { paths } from "./api";

type Json<Answers> = {
  [Status in keyof Answers]: Status extends 200 | 201 | 202
    ? Answers[Status] extends { content: { "application/json": infer Found } }
      ? Found
      : never
    : never;
}[keyof Answers];
type Answer<Operation> = Operation extends { responses: infer Answers } ? Json<Answers> : never;
type Body<Operation> = Operation extends { requestBody: { content: { "application/json": infer Sent } } }
  ? Sent
  : never;
type With<Method extends "get" | "post"> = {
  [Path in keyof paths]: paths[Path][Method] extends undefined ? never : Path;
}[keyof paths];
type Places = Record<string, string | number>;

/** The path with its {places} filled in. */
export function filled(path: string, places: Places): string {
  return path.replace(/\{(\w+)\}/g, (_, name: string) => encodeURIComponent(String(places[name])));
}

/** Reads something; `query` without its question mark. */
export async function get<Path extends With<"get">>(
  path: Path,
  places: Places = {},
  query = "",
): Promise<Answer<paths[Path]["get"]>> {
  return (await ask(filled(path, places) + (query && `?${query}`))) as Answer<paths[Path]["get"]>;
}

/** Gives a command; `query` without its question mark. */
export async function post<Path extends With<"post">>(
  path: Path,
  body: Body<paths[Path]["post"]>,
  places: Places = {},
  query = "",
): Promise<Answer<paths[Path]["post"]>> {
  return (await ask(filled(path, places) + (query && `?${query}`), body)) as Answer<paths[Path]["post"]>;
}
