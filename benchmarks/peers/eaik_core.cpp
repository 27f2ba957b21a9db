#include "EAIK.h"

extern "C" void *make(const double *H, const double *P, const double *R, int n)
{
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<const Rows> axes(H, 3, n), steps(P, 3, n + 1), turn(R, 3, 3);
    return new EAIK::Robot(axes, steps, Eigen::Matrix3d(turn));
}

extern "C" int many(void *robot, int poses, const double *T)
{
    int count = 0;
    for (int i = 0; i < poses; i++) {
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> pose(T + 16 * i);
        const auto found = static_cast<EAIK::Robot *>(robot)->calculate_IK(IKS::Homogeneous_T(pose));
        for (const bool least_squares : found.is_LS_vec) {
            count += !least_squares;
        }
    }
    return count;
}
