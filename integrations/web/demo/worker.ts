import { serveWorker } from "../src/worker";

serveWorker();
