// What every handler may use.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_CONTEXT_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_CONTEXT_H_

#include <chrono>

#include "service/server/catalogue/catalogue.h"
#include "service/server/jobs/executor.h"
#include "service/server/jobs/jobs.h"
#include "service/server/preview/preview_hub.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

// Outlives every call.
struct HandlerContext {
  Jobs& jobs;
  Executor& disk;                           // for what waits for the disk: never in a reactor
  const RootFolder& recordings;             // the folder that is served
  Catalogue& catalogue;                     // of its recordings
  Executor& catalogue_thread;               // for what waits for the catalogue
  std::chrono::milliseconds stalled_after;  // see StallGuard
  PreviewHub& previews;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_CONTEXT_H_
