#include "haptics/device.h"
