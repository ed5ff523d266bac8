// Who may do what: a button that the server would refuse is not shown. A login loads the page anew.

const ROLES = ["viewer", "operator", "admin"]; // each may do what those before it may

export type Role = "viewer" | "operator" | "admin";

/** Whether the person at this page has at least a role; nobody has one before the server has told. */
export const may = (needed: Role) => ROLES.indexOf(document.body.dataset.role ?? "") >= ROLES.indexOf(needed);
