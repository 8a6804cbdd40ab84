#pragma once
/// All of `basis/`: functions over the cells: measured materials, principal components, radial basis functions, a
/// discrepancy.

#include <gonio/basis/add_materials.hpp>
#include <gonio/basis/basis.hpp>
#include <gonio/basis/combine.hpp>
#include <gonio/basis/component_variance.hpp>
#include <gonio/basis/discrepancy.hpp>
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/joined.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/basis/mapped_materials.hpp>
#include <gonio/basis/material_functions.hpp>
#include <gonio/basis/measured.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/basis/project.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/basis/soft_specular_prior.hpp>
