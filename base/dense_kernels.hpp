#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

// The inner loops of Eigen's products of dense matrices and of its triangular solvers: every file
// that multiplies matrices of any size would compile all of them again. They are compiled in
// dense_kernels.cpp alone, for those who read this header (CMakeLists.txt, precompiled headers);
// who does not has copies of his own, of the same bits.
#ifndef ABUT_DENSE_KERNELS
#define ABUT_DENSE_KERNELS extern template
#endif

namespace Eigen::internal {

using AbutColumns = const_blas_data_mapper<double, Index, ColMajor>;
using AbutRows = const_blas_data_mapper<double, Index, RowMajor>;
using AbutSums = blas_data_mapper<double, Index, ColMajor, Unaligned, 1>;
using AbutTraits = gebp_traits<double, double>;

ABUT_DENSE_KERNELS struct gebp_kernel<double, double, Index, AbutSums, AbutTraits::mr,
                                      AbutTraits::nr, false, false>;
ABUT_DENSE_KERNELS struct gemm_pack_lhs<double, Index, AbutColumns, AbutTraits::mr,
                                        AbutTraits::LhsProgress, AbutTraits::LhsPacket4Packing,
                                        ColMajor, false, false>;
ABUT_DENSE_KERNELS struct gemm_pack_lhs<double, Index, AbutRows, AbutTraits::mr,
                                        AbutTraits::LhsProgress, AbutTraits::LhsPacket4Packing,
                                        RowMajor, false, false>;
ABUT_DENSE_KERNELS struct gemm_pack_rhs<double, Index, AbutColumns, AbutTraits::nr, ColMajor, false,
                                        false>;
ABUT_DENSE_KERNELS struct gemm_pack_rhs<double, Index, AbutRows, AbutTraits::nr, RowMajor, false,
                                        false>;
ABUT_DENSE_KERNELS struct general_matrix_vector_product<Index, double, AbutColumns, ColMajor, false,
                                                        double, AbutRows, false>;
ABUT_DENSE_KERNELS struct general_matrix_vector_product<Index, double, AbutColumns, ColMajor, false,
                                                        double, AbutColumns, false>;
ABUT_DENSE_KERNELS struct general_matrix_vector_product<Index, double, AbutRows, RowMajor, false,
                                                        double, AbutColumns, false>;
ABUT_DENSE_KERNELS struct general_matrix_vector_product<Index, double, AbutRows, RowMajor, false,
                                                        double, AbutRows, false>;

}  // namespace Eigen::internal
