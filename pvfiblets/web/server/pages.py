"""The front server's own pages: token, opening, full, ended, refused. Only the opening page needs a script."""

from __future__ import annotations

from html import escape

# Vue compiles its templates in the browser, which needs 'unsafe-eval'; nothing is loaded from, or sent to, elsewhere.
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' blob: data:; font-src 'self' data:; connect-src 'self'; object-src 'none'; base-uri 'self'; "
    "form-action 'self'; frame-ancestors 'self'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Server": "pvfiblets",  # aiohttp would tell the versions of the libraries
}

STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif }
body { margin: 0; min-height: 100vh; display: grid; place-items: center; background: Canvas; color: CanvasText }
main { max-width: 30rem; padding: 2rem }
h1 { font-size: 1.4rem; margin: 0 0 .5rem }
p { margin: .5rem 0 }
input, button, a.button { font: inherit; padding: .5rem .9rem; border-radius: .4rem; border: 1px solid GrayText }
button, a.button { background: #1867c0; color: white; border-color: #1867c0; text-decoration: none; cursor: pointer }
form { display: flex; gap: .5rem; margin-top: 1rem }
input { flex: 1; min-width: 0 }
.bar { height: 4px; border-radius: 2px; background: #1867c0; animation: wait 1.2s ease-in-out infinite alternate }
@keyframes wait { from { width: 10%; margin-left: 0 } to { width: 40%; margin-left: 60% } }
"""


# A session begins when this connects. Whoever only fetches pages starts nothing.
BEGIN = """
const say = (text) => { document.getElementById("said").textContent = text };
if (!navigator.cookieEnabled) say("This page needs cookies, to find your session.");
else {
  const socket = new WebSocket(`${location.protocol.replace("http", "ws")}//${location.host}/begin`);
  let told = false;
  socket.onmessage = ({ data }) => {
    told = true;
    location.replace(data === "ready" ? "/index.html?reconnect=auto" : "/");
  };
  socket.onclose = () => {
    if (told) return;
    say("The server does not answer; trying again.");
    setTimeout(() => location.replace("/"), 2000);
  };
}
"""


def page(title: str, body: str) -> str:
    """Return a whole page around trusted HTML."""
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">'
        f"<title>{escape(title)} · pvfiblets</title><style>{STYLE}</style></head>"
        f"<body><main><h1>{escape(title)}</h1>{body}</main></body></html>"
    )


def ask_token(wrong: bool) -> str:
    """Return the page that asks for the token."""
    hint = "<p><strong>That is not the token.</strong></p>" if wrong else ""
    return page(
        "A token is needed",
        f"{hint}<p>When it starts, the server prints an address with the token, or the file that holds it. Open "
        'that address, or enter the token here.</p><form method="post" action="/token">'
        '<input name="token" type="password" autofocus autocomplete="off" aria-label="Token">'
        "<button>Open</button></form>",
    )


def opening() -> str:
    """Return the page that begins a session, waits for it, and goes there by itself."""
    return page(
        "Opening…",
        '<div class="bar"></div><p id="said">The scene is being prepared.</p>'
        f"<noscript><p>This page needs JavaScript.</p></noscript><script>{BEGIN}</script>",
    )


def full(limit: int) -> str:
    """Return the page beyond the limit of sessions."""
    many = "one session is" if limit == 1 else f"{limit} sessions are"
    return page(
        "All sessions are taken",
        f"<p>{many.capitalize()} open, the most that this server allows at once. Try again when another session "
        'has ended.</p><p><a class="button" href="/">Try again</a></p>',
    )


def ended(reason: str | None, restorable: bool = False) -> str:
    """Return the page of a session that is over."""
    why = "<p>The session was closed.</p>" if reason is None else f"<p>The session failed: {escape(reason)}</p>"
    why += "<p>Its last state is kept for an hour.</p>" if restorable else ""
    restore = '<button formaction="/new?restore=1">Restore</button>' if restorable else ""
    return page(
        "Session ended", f'{why}<form method="post" action="/new">{restore}<button>Open a new one</button></form>'
    )


def refused(reason: str) -> str:
    """Return the page of a refusal."""
    return page("Refused", f"<p>{escape(reason.capitalize())}.</p>")
