// The API's Result under the name that the library's own sources use. The public header does not use it: X11 has a macro of that name.
#pragma once

#include "obscura/ao.h"

namespace obscura::ao {

using Status = Result;

}  // namespace obscura::ao
