/// <reference types="vitest/config" />
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin } from "vite";

/** What the pages share with the panel of one task is served as it is: ../static/x.js as /x.js. */
function old(served: boolean): Plugin {
  const file = (name: string) => new URL(`../static/${name}`, import.meta.url).pathname;
  return {
    name: "old",
    enforce: "pre",
    resolveId(id) {
      const name = /^old\/(.*)/.exec(id)?.[1];
      return name && (served ? { id: `/${name}`, external: "absolute" } : file(name));
    },
  };
}

export default defineConfig(({ command }) => ({
  plugins: [react(), old(command === "build")],
  build: {
    outDir: "../built",
    emptyOutDir: true,
    assetsInlineLimit: 0, // the policy of the site lets no data: address in
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 600, // kB: three, which only the picture in 3D loads
  },
  server: { fs: { allow: ["../../.."] } }, // tests read tasks of the field
  // Tests that need a document begin with `// @vitest-environment jsdom`: it takes longer than most tests.
  test: { cache: false, fsModuleCache: false, testTimeout: 120_000 }, // nothing is written beside the sources,
}));
