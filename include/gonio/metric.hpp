#pragma once
/// All of `metric/`: the error metrics.

#include <gonio/metric/any_metric.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/location_free.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/metric/root.hpp>
