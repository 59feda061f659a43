// SPDX-License-Identifier: MIT
#include "accuracy/peers/peer.h"

namespace cdprep::test {

std::vector<Peer> all_peers() {
    std::vector<Peer> peers;
#ifdef CDPREP_HAVE_FCL
    add_fcl(peers);
#endif
#ifdef CDPREP_HAVE_CCD
    add_ccd(peers);
#endif
#ifdef CDPREP_HAVE_BULLET
    add_bullet(peers);
#endif
#ifdef CDPREP_HAVE_ODE
    add_ode(peers);
#endif
#ifdef CDPREP_HAVE_CGAL
    add_cgal(peers);
#endif
    return peers;
}

}  // namespace cdprep::test
