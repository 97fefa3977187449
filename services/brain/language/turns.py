"""Words that put a command behind the one under way, or in its place. Pure."""

import re

from common.language.timing import THERE

LATER = re.compile(
    r"^(?:and )?(?:"
    r"(?:when|once|as soon as|after) you(?: are| have)?(?: all)? "
    r"(?:done|finished|ready|through|free|back|did|get back|come back)(?:(?: with)? (?:that|this|it))?|"
    r"(?:when|once|as soon as|after) (?:that|this|it)(?: is| has)?(?: been)? (?:done|finished|over|ready)|"
    rf"{THERE}|"
    r"then|after(?:wards?| that| this| it)?|next|later(?: on)?|in addition|on top of that)\b[, ]*"
)
"""Words before a command that put it behind the one under way."""
LATER_END = re.compile(
    r"[, ]+(?:after(?:wards| that| this)?|next|later(?: on)?|too|as well|"
    rf"(?:when|once) you(?: are|'re| have|'ve| get| come) (?:done|finished|ready|back)|{THERE})$"
)
"""The same behind it."""
AFTER_DOING = re.compile(
    r"^(?:and )?(?:after|once|when|as soon as) (?!(?:that|this|it)\b)(?P<you>you(?: are| have)?(?: all)? )?"
    r"(?:(?:done|finished|ready|through)(?: with)? )?(?P<rest>.+)$"
)
"""Before words about the command under way, behind which the next one is to come."""
INSTEAD = re.compile(
    r"^(?:no(?! (?:rush|hurry|worries|problem|pressure|stress|need|matter|thanks|time)\b)|"
    r"whatever you are doing|(?:drop|leave|stop) everything(?=,? and\b|,)|before you (?:go on|carry on|continue|"
    r"do that|do it|finish)(?: with (?:that|it|this))?|"
    r"stop(?! by\b| (?!bring\b)\w+ing\b)(?: (?:that|it|this|everything|what you are doing))?|"
    r"wait(?! (?:for|here|there|in|at|by|on|until|till)\b)|sorry|"
    r"hold on|hang on|"
    r"(?:forget|scrap|leave|drop|cancel|never mind|skip) (?:about )?"
    r"(?:that|it|this|(?:the|my) \w+(?: \w+)?(?=,))|never ?mind|"
    r"scratch that|change of plans?|new plan|i(?: have|'ve)? changed my mind|actually|on second thoughts?|"
    r"instead|rather|"
    r"(?:do not|don't) (?:do that|bother)(?: and)?)\b[, ]+(?:and |but )?"
)
"""Words before a command that puts it in the place of the one under way."""
INSTEAD_END = re.compile(r"[, ]+(?:instead(?: of (?:that|it|this))?|rather)$")
