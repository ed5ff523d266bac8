import { createRoot } from "react-dom/client";
import { App } from "./app";
import "./texts";

const root = document.getElementById("root");
if (root !== null) {
  createRoot(root).render(<App />);
}
