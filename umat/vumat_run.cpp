#include "call.hpp"
#include "vumat.hpp"

namespace lode {

bool run_vumat(const VumatHeader& header, const VumatArguments& arguments, int first_point) {
    const Call call = prepare_call(HostProgram::explicit_, header.cmname, header.props, header.nprops, header.ndir,
                                   header.nshr, arguments.nstatev);
    if (call.material == nullptr) [[unlikely]]
        return false;
    CallStatus status;
    const ModelEntry& entry = *call.material->entry;
    (header.probe ? entry.probe : entry.vumat)[call.kind](call.material->object, arguments, status);
    if (status.failure != nullptr) [[unlikely]] {
        report_error_and_stop(HostProgram::explicit_, failure_text(*call.material, status) + " (point " +
                                                          std::to_string(first_point + status.failed_point) +
                                                          " of the block)");
        return false;
    }
    if (status.warning != nullptr) [[unlikely]]
        warn_once(HostProgram::explicit_, *call.material, status.warning);
    return true;
}

}  // namespace lode
