#include "obscura/ao.h"

obscura::ao::Status touch(obscura::ao::Context* context) { return obscura::ao::setMethod(context, "hbao", {}); }
