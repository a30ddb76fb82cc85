// The page in a real browser: Debian's chromium, headless, drawing in software.
import { defineConfig } from "@playwright/test";

export default defineConfig({
  testDir: "tests",
  testMatch: "*.spec.ts",
  outputDir: "test-results",
  workers: 1,
  // A browser that draws in software stalls now and then on a busy machine. What passes at the second try is
  // listed as flaky; what is wrong fails twice.
  retries: 1,
  timeout: 120_000,
  expect: { timeout: 30_000 },
  reporter: [["list"], ["junit", { outputFile: process.env.HEXHEX_PAGE_JUNIT ?? "junit.xml" }]],
  use: {
    viewport: { width: 1000, height: 700 },
    colorScheme: "light",
    acceptDownloads: true,
    launchOptions: {
      executablePath: process.env.HEXHEX_CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    },
  },
});
