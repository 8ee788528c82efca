// Harness of a single module: the common interface without additions.

#define INSTANCE Harness
#include "interface.h"
